// Points of a response curve on its own equations again: between two points, or with more harmonics.
#pragma once
#include "hbm/options.hpp"
#include "hbm/system.hpp"
#include "paths/metric.hpp"

namespace plm {

/// 1 is the size of the unknowns at a point or the width of the range of frequencies.
Metric curve_metric(const PathState &at, const HbmOptions &options);

/// Moves the point to the curve of `system` within the plane across `direction`. `factored`: the system was
/// linearized near it. False: Newton's method did not converge, or went far; the point is as it was.
bool correct_across(Residual &system, const Metric &metric, const HbmOptions &options,
                    const PathState &direction, PathState &point, bool factored = false);

PathState load(HbmSystem &system, const BranchPoint &point);

} // namespace plm
