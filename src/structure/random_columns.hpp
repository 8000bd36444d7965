// Entries without a pattern.
#pragma once
#include "linalg/dense.hpp"

namespace plm {

/// In (-1, 1): the same in every run, on every machine.
void pseudo_random(Matrix &x, std::int64_t seed);

} // namespace plm
