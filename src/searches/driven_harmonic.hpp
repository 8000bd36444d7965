// What the equations of a backbone, of harmonic balance or of exact motions, have in common.
#pragma once
#include "hbm/branch_point.hpp"
#include "hbm/options.hpp"
#include "structure/loads.hpp"

namespace plm {

/// The lowest dynamic harmonic with a load; null: nothing is driven.
const std::pair<const int, HarmonicLoad> *driven_harmonic(const HarmonicLoads &excitation);

/// The response at the force asked for, of one at another: a change of omega over the whole range counts as
/// much as it. 1 where nothing moves.
double response_at_force(double response, const BranchPoint &about, const HbmOptions &options);

} // namespace plm
