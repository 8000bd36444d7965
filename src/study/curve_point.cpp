#include "study/curve_point.hpp"
#include "hbm/newton.hpp"
#include <cmath>

namespace plm {

CurveMetric::CurveMetric(const CurvePoint &at, const HbmOptions &o)
    : width_(2 * M_PI * (o.frequency_max_hz - o.frequency_min_hz)) {
    const double size = norm2(static_cast<std::int64_t>(at.x.size()), at.x.data());
    per_square_ = size > 0 ? 1 / (size * size) : 1;
}

double CurveMetric::product(const vector<double> &x, double omega, const vector<double> &y,
                            double other_omega) const {
    return per_square_ * dot(static_cast<std::int64_t>(x.size()), x.data(), y.data()) +
           omega * other_omega / (width_ * width_);
}

bool correct_across(HbmSystem &system, const CurveMetric &metric, const HbmOptions &options,
                    const vector<double> &direction_x, double direction_omega, CurvePoint &point,
                    bool factored) {
    vector<double> weight(direction_x);
    for (double &w : weight) w *= metric.per_square();
    const double width = metric.omega_scale();
    const SideCondition side{&weight, direction_omega / (width * width)};
    NewtonLimits limits;
    limits.tolerance = 1e-3 * options.tolerance; // the distances looked for are small differences
    limits.max_iterations = options.max_iterations;
    limits.omega_scale = width;
    limits.factored = factored;
    CurvePoint moved = point;
    if (!newton(system, side, limits, moved.x, moved.omega).converged) return false;
    vector<double> change(moved.x);
    for (std::size_t i = 0; i < change.size(); ++i) change[i] -= point.x[i];
    const double shift = moved.omega - point.omega;
    if (!(metric.product(change, shift, change, shift) < 0.3 * 0.3)) return false; // another curve
    point = std::move(moved);
    return true;
}

CurvePoint load(HbmSystem &system, const BranchPoint &point) {
    CurvePoint p;
    p.x.resize(static_cast<std::size_t>(system.size()));
    system.from_point(point, p.x.data());
    p.omega = point.omega;
    return p;
}

} // namespace plm
