#include "motions/tracer.hpp"
#include "motions/compressed_motion.hpp"
#include "reduction/widened_model.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// What begins anew costs a factorization, and what a curve goes on from is followed once more.
constexpr std::int64_t steps_between_stands = 10;

// The points of a curve but for those located on it, in the coordinates of this model. None: they cannot be
// had.
std::vector<BranchPoint> on_model(const Branch &curve, const std::shared_ptr<const ReducedModel> &model) {
    std::vector<BranchPoint> points;
    const bool same = curve.reduced_model() == model;
    if (!same && !of_one_basis(curve.reduced_model(), model)) return points;
    for (const BranchPoint &p : curve.points()) {
        if (p.bifurcation != bifurcation::none) continue;
        BranchPoint there = same ? p : uncompressed(curve.reduced(), p);
        if (!same && model->from && !compress(*model, there, there)) return {};
        points.push_back(std::move(there));
    }
    return points;
}

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
    if (start.beside) guide_ = guide_by(start.beside.get(), start.point.omega);
    range.guide = guide_.get();
    keep_points([&] { follow_on(range, path); });
}

// From there on: its motions, as large as the force makes them here.
std::unique_ptr<PathGuide> CurveTracer::guide_by(const Branch *known, double omega) const {
    const double ratio = known->force_scale() != 0 ? limits_.force_scale / known->force_scale() : 1;
    const auto ordinary =
        std::make_shared<std::vector<BranchPoint>>(on_model(*known, branch_.reduced_model()));
    if (ordinary->empty()) return nullptr;
    if (std::abs(ordinary->back().omega - omega) < std::abs(ordinary->front().omega - omega))
        std::reverse(ordinary->begin(), ordinary->end());
    return std::make_unique<PathGuide>(ordinary->size(), [this, ordinary, ratio](std::size_t i) {
        PathState state = state_of((*ordinary)[i]);
        for (std::size_t j = static_cast<std::size_t>(equations_->static_size()); j < state.x.size(); ++j)
            state.x[j] *= ratio;
        return state;
    });
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
