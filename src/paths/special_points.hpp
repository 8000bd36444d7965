// Folds, branch points and whatever else a path's owner tests for, located between two neighbouring points.
#pragma once
#include "paths/path_walker.hpp"

namespace plm {

/// A step along a path.
struct PathStep {
    const PathState &before, &after, &tangent_before, &tangent_after;
    double length;
};

/// A point at which a test function changes its sign.
struct SpecialPoint {
    double position = 0; // on the chord, 0 to 1
    PathState at;
    std::int32_t kind = 0; // PLM_BIFURCATION_..., or the owner's
    double residual = 0;
};

struct SpecialPoints {
    std::vector<SpecialPoint> found; // in their order along the step
    bool jumped = false;             // the step seems to have crossed to another curve
};

/// Whether a test function changes its sign.
bool any_special_points(const vector<double> &tests_before, const vector<double> &tests_after);
/// Zeros of the test functions, whose values at both ends are given; `orientation`: of the path before the
/// step. Leaves the walker where its search ended.
SpecialPoints find_special_points(PathWalker &walker, const PathOptions &options, const PathStep &step,
                                  double orientation, const vector<double> &tests_before,
                                  const vector<double> &tests_after);

} // namespace plm
