// A path of solutions as its owner sees it: what is asked for, and what is heard of each point.
#pragma once
#include "linalg/memory.hpp"
#include <cstdint>

namespace plm {

class PathGuide; // path_guide.hpp

struct PathOptions {
    double low = 0, high = 0; // range of p
    bool upward = false;      // direction at the start, unless PathStart gives one
    double tolerance = 1e-9;
    std::int64_t max_iterations = 30, max_points = 2000;
    double initial_step = 0, min_step = 1e-7, max_step = 0.15; // arc length; initial 0: a fifth of max_step
    // Lengths are those of the response of now, not of the largest so far: for a curve that comes and goes at
    // small responses, as motions of several periods do from the shorter ones, which a coarse step would
    // go on along.
    bool scale_falls = false;
    bool locate = false;        // folds, branch points and changes of the owner's test functions
    PathGuide *guide = nullptr; // a neighbouring path by which steps are longer, or null
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

} // namespace plm
