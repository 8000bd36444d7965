// What the equations of a backbone, of harmonic balance or of exact motions, measure their unknowns by.
#pragma once
#include "hbm/branch_point.hpp"
#include "hbm/options.hpp"

namespace plm {

/// The response at the force asked for, of one at another: a change of omega over the whole range counts as
/// much as it. 1 where nothing moves.
double response_at_force(double response, const BranchPoint &about, const HbmOptions &options);

} // namespace plm
