// Pseudo-arc-length continuation of R(x, p) = 0, p the frequency of a response curve or the force on the way
// from rest to a first solution, in a metric where 1 is the width of the range of p or the largest dynamic
// response so far.
#pragma once
#include "hbm/newton.hpp"
#include "linalg/monitor.hpp"

namespace plm {

struct PathOptions {
    double low = 0, high = 0; // range of p
    bool upward = false;      // direction at the start
    double tolerance = 1e-9;
    std::int64_t max_iterations = 30, max_points = 2000;
    double initial_step = 0, min_step = 1e-7, max_step = 0.15; // arc length; initial 0: a fifth of max_step
};

/// One converged point of a path, as its owner wants to keep it.
struct PathPoint {
    const vector<double> &x;
    double parameter, arclength, residual;
    std::int64_t iterations;
};

class PathOwner {
  public:
    virtual ~PathOwner() = default;
    virtual void record(const PathPoint &point) = 0;
    virtual bool cancelled(double fraction) = 0;
    /// A solution near p by other means when the path is stuck; x is the last one on entry. False: none.
    virtual bool rescue(double parameter, vector<double> &x) = 0;
};

struct PathOutcome {
    std::int32_t end_reason = PLM_REASON_NONE;
    vector<double> x; // the last point
    double parameter = 0;
    std::int64_t newton_iterations = 0, factorizations = 0, failed_steps = 0;
};

/// Follows the path through (x, p) until it leaves the range, closes, or cannot go on. The last point lies on
/// the boundary of the range when it was left (PLM_REASON_RANGE_END). `system` takes p in the place of omega.
PathOutcome follow_path(HbmSystem &system, const PathOptions &options, const vector<double> &x,
                        double parameter, double first_residual, PathOwner &owner);

} // namespace plm
