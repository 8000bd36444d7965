// How nearly a point of a branch is a periodic motion.
#pragma once
#include "motions/branch.hpp"

namespace plm {

/// The state at the beginning of the period against that one period on by the exact flow: see
/// periodicity_defect() of orbits/shooting.hpp.
double periodicity_defect(const Branch &branch, std::int64_t point);

} // namespace plm
