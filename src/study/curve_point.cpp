#include "study/curve_point.hpp"
#include "hbm/solved_point.hpp"
#include "motions/branch_path.hpp"
#include <cmath>

namespace plm {

Metric curve_metric(const PathState &at, const HbmOptions &o) {
    const double size = norm2(static_cast<std::int64_t>(at.x.size()), at.x.data());
    return {size > 0 ? size : 1, 2 * M_PI * (o.frequency_max_hz - o.frequency_min_hz)};
}

bool correct_across(Residual &system, const Metric &metric, const HbmOptions &options,
                    const PathState &direction, PathState &point, bool factored) {
    NewtonLimits limits = newton_limits(options);
    limits.aim = 1e-3 * limits.tolerance; // the distances looked for are small differences
    limits.factored = factored;
    PathState moved = point;
    if (!newton_across(system, metric, direction, limits, moved).converged) return false;
    if (!(metric.distance(moved, point) < 0.3)) return false; // another curve
    point = std::move(moved);
    return true;
}

PathState load(HbmSystem &system, const BranchPoint &point) {
    return {unknowns_of(system, point), point.omega};
}

} // namespace plm
