// From solutions of the harmonic-balance equations, and from paths of them, to the points of a branch.
#pragma once
#include "hbm/branch.hpp"
#include "hbm/options.hpp"
#include "hbm/system.hpp"
#include "paths/continuation.hpp"

namespace plm {

NewtonLimits newton_limits(const HbmOptions &options);
/// A path from `low` to `high` with the tolerance and the steps of a curve.
PathOptions path_options(const HbmOptions &options, double low, double high);

/// The unknowns of a point.
vector<double> unknowns_of(HbmSystem &system, const BranchPoint &point);
/// What the search for a solution tells of it.
void put_record(double residual, std::int64_t iterations, std::int64_t n_switching, BranchPoint &point);
/// Where it stands on its path.
void put_place(const PathPoint &at, BranchPoint &point);
/// A solution at which the system has just been evaluated, into a point that keeps what else it knows.
void put_solution(HbmSystem &system, const PathState &at, double residual, std::int64_t iterations,
                  BranchPoint &point);
/// The same as a new point.
BranchPoint solved_point(HbmSystem &system, const PathState &at, double residual, std::int64_t iterations);
BranchPoint solved_point(HbmSystem &system, const PathPoint &point);

/// How a path ended that was kept in `branch`, and what it has cost.
void take_outcome(const PathOutcome &outcome, Branch &branch);

/// One branch from two that begin at the same point and lead away from it to both sides: from the far end of
/// `before` to that of `after`. It ends as `after` does.
std::shared_ptr<Branch> joined(const Branch &before, const Branch &after);

} // namespace plm
