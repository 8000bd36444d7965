#include "motions/tracer.hpp"
#include <cmath>

namespace plm {
namespace {

// What begins anew costs a factorization, and what a curve goes on from is followed once more.
constexpr std::int64_t steps_between_stands = 10;

} // namespace

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

void CurveTracer::follow_on(const PathOptions &range, const PathStart &start) {
    if (known()) equations_->take(known()->memory);
    PathOutcome out = known() ? go_on_with_path(*equations_, range, known()->path, *this)
                              : follow_path(*equations_, range, start, *this);
    for (;;) {
        take_outcome(out, branch_);
        if (out.end_reason != reason::none) return;
        stand(out);
        out = go_on_with_path(*equations_, range, out, *this);
    }
}

bool CurveTracer::interrupt() {
    if (++since_stand_ >= steps_between_stands) return true;
    if (recorder_) recorder_->pass(branch_);
    return false;
}

void CurveTracer::stand(const PathProgress &at, const HarmonicChoices &choices) {
    since_stand_ = 0;
    EquationsMemory memory = equations_->settle();
    if (!recorder_) return;
    CurveProgress now;
    now.n_points = static_cast<std::int64_t>(branch_.points().size());
    now.newton_work = branch_.newton_work;
    now.failed_steps = branch_.failed_steps;
    now.unknowns_used = branch_.unknowns_used;
    now.path = at;
    now.memory = std::move(memory);
    now.harmonics = choices;
    recorder_->stand(std::move(now), branch_);
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
