// From solutions of the harmonic-balance equations to the points of a branch, and back.
#pragma once
#include "hbm/system.hpp"
#include "paths/metric.hpp"
#include "paths/path.hpp"

namespace plm {

/// The unknowns of a point.
vector<double> unknowns_of(HbmSystem &system, const BranchPoint &point);
/// A solution at which the system has just been evaluated, into a point that keeps what else it knows.
void put_solution(HbmSystem &system, const PathState &at, double residual, std::int64_t iterations,
                  BranchPoint &point);
/// The same as a new point.
BranchPoint solved_point(HbmSystem &system, const PathState &at, double residual, std::int64_t iterations);
BranchPoint solved_point(HbmSystem &system, const PathPoint &point);

} // namespace plm
