// Pseudo-arc-length continuation of R(x, p) = 0, p the frequency of a response curve, the force on the way
// from rest to a first solution, ..., in a metric where 1 is the width of the range of p or the largest
// dynamic response so far. Folds and branch points are located on the way, and whatever else changes the sign
// of a test function of the path's owner.
#pragma once
#include "hbm/newton.hpp"
#include "linalg/monitor.hpp"

namespace plm {

struct PathOptions {
    double low = 0, high = 0; // range of p
    bool upward = false;      // direction at the start, unless PathStart gives one
    double tolerance = 1e-9;
    std::int64_t max_iterations = 30, max_points = 2000;
    double initial_step = 0, min_step = 1e-7, max_step = 0.15; // arc length; initial 0: a fifth of max_step
    bool locate = false; // folds, branch points and changes of the owner's test functions
};

/// Where a path begins: a solution, and the side on which it is left.
struct PathStart {
    vector<double> x = {};
    double parameter = 0, residual = 0;
    vector<double> direction_x = {}; // empty: by PathOptions::upward
    double direction_parameter = 0;
    double scale = 0;   // of the metric; 0: the response at x
    bool record = true; // false: a path that goes on, its first point is known already
    // not empty: the path is closed when it comes back here in this direction; otherwise at x
    vector<double> end_x = {}, end_direction_x = {};
    double end_parameter = 0, end_direction_parameter = 0;
};

/// One converged point of a path, as its owner wants to keep it. The system is linearised there.
struct PathPoint {
    const vector<double> &x;
    double parameter, arclength, residual;
    std::int64_t iterations;
    std::int32_t bifurcation; // PLM_BIFURCATION_...
};

class PathOwner {
  public:
    virtual ~PathOwner() = default;
    virtual void record(const PathPoint &point) = 0;
    virtual bool cancelled(double fraction) = 0;
    /// A solution near p by other means when the path is stuck; x is the last one on entry. False: none.
    virtual bool rescue(double parameter, vector<double> &x) = 0;
    /// Test functions at a solution where the system is linearised, one value for each kind of
    /// test_kinds(); where one changes its sign smoothly, the point is located and recorded.
    virtual void test(const vector<double> &, double, vector<double> &) {}
    virtual vector<std::int32_t> test_kinds() const { return {}; }
    /// Asked after each point: true ends the path with PLM_REASON_NONE, to go on by another system.
    virtual bool interrupt() { return false; }
};

struct PathOutcome {
    std::int32_t end_reason = PLM_REASON_NONE; // PLM_REASON_NONE: interrupted by its owner
    vector<double> x;                          // the last point
    double parameter = 0;
    vector<double> direction_x; // unit tangent there, in the direction travelled
    double direction_parameter = 0;
    double orientation = 1; // sign of det(dR/dx) times that of direction_parameter
    double scale = 0, arclength = 0, step = 0;
    std::int64_t newton_iterations = 0, factorizations = 0, failed_steps = 0, n_points = 0;
    double newton_seconds = 0;
};

/// Follows the path from `start` until it leaves the range, closes, or cannot go on. The last point lies on
/// the boundary of the range when it was left (PLM_REASON_RANGE_END; PLM_REASON_TURNED_BACK when it came back
/// to where it began, against the direction in which it had left). `system` takes p in the place of omega.
PathOutcome follow_path(HbmSystem &system, const PathOptions &options, const PathStart &start,
                        PathOwner &owner);

} // namespace plm
