#include "motions/tracer.hpp"
#include <cmath>

namespace plm {

void Tracer::follow(Residual &system, const PathOptions &options, const PathStart &start) {
    keep_points([&] { take_outcome(follow_path(system, options, start, *this), branch_); });
}

void Tracer::keep_points(const std::function<void()> &follow) {
    try {
        follow();
    } catch (const Error &e) {
        if (e.status() != status::cancelled || branch_.points().empty()) throw;
        branch_.end_reason = e.reason();
    }
}

void CurveTracer::run(const CurveStart &start) {
    PathOptions range =
        path_options(limits_, 2 * M_PI * limits_.frequency_min_hz, 2 * M_PI * limits_.frequency_max_hz);
    range.upward = limits_.upward;
    range.initial_step = limits_.initial_step;
    range.locate = limits_.bifurcations;
    PathStart path = leaving(start.point, start.towards.empty() ? start.point : start.towards[0]);
    if (start.towards.empty()) path.direction.x.clear();
    if (start.away) scale_by(-1, path.direction);
    path.residual = start.point.residual;
    keep_points([&] { follow_on(range, path); });
}

PathStart CurveTracer::leaving(const BranchPoint &point, const BranchPoint &next) const {
    PathStart path;
    path.at = state_of(point);
    path.direction = difference(state_of(next), path.at);
    return path;
}

BranchPoint CurveTracer::point_of(const PathPoint &at) {
    BranchPoint point = equations_->solved_point({at.x, at.parameter}, at.residual, at.iterations);
    put_place(at, point);
    if (equations_->has_multipliers()) point.multipliers = equations_->multipliers(at.x, at.parameter);
    return point;
}

void CurveTracer::record(const PathPoint &at) {
    branch_.append(point_of(at));
}

bool CurveTracer::rescue(double omega, vector<double> &x) {
    return equations_->find(omega, watch_, x, branch_.newton_work);
}

vector<std::int32_t> CurveTracer::test_kinds() const {
    if (!equations_->has_multipliers()) return {};
    return {bifurcation::period_doubling, bifurcation::neimark_sacker};
}

void CurveTracer::test(const vector<double> &x, double omega, vector<double> &values) {
    if (equations_->has_multipliers()) values = bifurcation_tests(equations_->multipliers(x, omega));
}

} // namespace plm
