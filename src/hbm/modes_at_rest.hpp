// The linear modes about the contact at rest, in reduced coordinates: where nonlinear modes and backbones
// begin.
#pragma once
#include "hbm/options.hpp"
#include "motions/branch_point.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

/// Modes with pair i coupled by coupling[i] k_n at all times, ascending; exactly 0: rigid-body motion that
/// nothing holds.
SpaceModes modes_at_rest(const ReducedModel &reduced, const vector<double> &coupling);

/// Linear responses about rest at the undamped frequencies inside the range of the options, each at a force
/// at which no pair switches yet. None of pairs that touch without pressure.
std::vector<BranchPoint> linear_resonances(std::shared_ptr<const ReducedModel> reduced,
                                           const HbmOptions &options);

} // namespace plm
