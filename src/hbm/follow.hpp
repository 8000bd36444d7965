// From a known solution to another frequency along its branch, and what is said where that fails.
#pragma once
#include "hbm/options.hpp"
#include "hbm/start.hpp"
#include "motions/branch.hpp"

namespace plm {

/// Follows the solution near x at frequency `from` to the frequency `to`; the way is short where a step along
/// the tangent is near a solution already, and else a continuation. Not converged: no solution near x, or its
/// branch turns back before; x is then unchanged.
StartOutcome follow_to(HbmSystem &system, const HbmOptions &options, double from, double to, Watch watch,
                       vector<double> &x);

/// After follow_to() has failed: the branch says that the solution x at omega, found otherwise, may be on
/// another branch than `start`, whose unknowns are `guessed`, unless it is near.
void warn_of_other_branch(const HbmSystem &system, const vector<double> &guessed, const vector<double> &x,
                          const BranchPoint &start, double omega, Branch &branch);

} // namespace plm
