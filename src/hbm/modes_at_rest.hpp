// The linear modes about the contact at rest, in reduced coordinates: where nonlinear modes and backbones
// begin.
#pragma once
#include "reduction/reduced_model.hpp"

namespace plm {

/// Modes with pair i coupled by coupling[i] k_n at all times, ascending; exactly 0: rigid-body motion that
/// nothing holds.
SpaceModes modes_at_rest(const ReducedModel &reduced, const vector<double> &coupling);

} // namespace plm
