// From a path of solutions to a branch.
#pragma once
#include "motions/branch.hpp"
#include "motions/options.hpp"
#include "paths/continuation.hpp"

namespace plm {

NewtonLimits newton_limits(const MotionOptions &options);
/// A path from `low` to `high` with the tolerance and the steps of a curve.
PathOptions path_options(const MotionOptions &options, double low, double high);

/// What the search for a solution tells of it.
void put_record(double residual, std::int64_t iterations, std::int64_t n_switching, BranchPoint &point);
/// Where it stands on its path.
void put_place(const PathPoint &at, BranchPoint &point);

/// How a path ended that was kept in `branch`, and what it has cost.
void take_outcome(const PathOutcome &outcome, Branch &branch);

/// One branch from two that begin at the same point and lead away from it to both sides: from the far end of
/// `before` to that of `after`. It ends as `after` does.
std::shared_ptr<Branch> joined(const Branch &before, const Branch &after);

} // namespace plm
