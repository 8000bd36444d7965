// The harmonics that a first solution has.
#pragma once
#include "reduction/reduced_model.hpp"

namespace plm {

/// The highest harmonic with a load, at least 1.
std::int64_t highest_excitation(const ReducedModel &reduced);

/// What a first solution is looked for with, unless more are asked for: few, but all of the excitation's.
std::int64_t few_harmonics(const ReducedModel &reduced);

} // namespace plm
