#include "hbm/exact_motion.hpp"
#include "transient/period_map.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr int max_steps = 10;
constexpr double same_motion = 0.3;  // of the motion's size: farther away it is another one
constexpr double safe_share = 0.002; // of the multipliers' distance from the unit circle
constexpr double near_enough = 1e-6; // whatever the multipliers
constexpr double most_flops = 1e9;   // of one period of the flow: a tenth of a second or two

// The fastest motion of the open structure bounds the length of the flow's pieces from above.
bool affordable(const ExactFlow &flow, std::int64_t periods) {
    const FlowModel &model = flow.model();
    double fastest = 0;
    for (std::int64_t j = 0; j < model.n_massive(); ++j) fastest = std::max(fastest, model.lambda()[j]);
    const double n = static_cast<double>(model.size()), z = static_cast<double>(model.n_pairs()),
                 pieces = 16 + 0.5 * std::sqrt(fastest) * flow.period() * static_cast<double>(periods);
    return pieces * 26 * 2 * n * (n + z) < most_flops;
}

// The flag is safe when the multipliers are farther from the unit circle than they are uncertain.
double margin(const Matrix &monodromy) {
    double least = 1;
    for (const std::complex<double> &m : multipliers(monodromy))
        least = std::min(least, std::abs(std::abs(m) - 1));
    return least;
}

} // namespace

Matrix MotionBeside::monodromy(std::shared_ptr<const FlowModel> model, const BranchPoint &point,
                               const Matrix &within) {
    const double omega = point.omega / static_cast<double>(periods_);
    const FlowState start = model->state(point.eta_0, point.eta, omega, 0.0);
    ExactFlow flow(std::move(model), point.omega, point.force_scale, watch_);
    if (!affordable(flow, periods_)) return {};
    Matrix found;
    if (!correction_.empty()) found = search(flow, start, moved(flow.model(), start, correction_, 1), within);
    return found.rows() > 0 ? found : search(flow, start, start, within);
}

Matrix MotionBeside::search(ExactFlow &flow, const FlowState &start, FlowState now, const Matrix &within) {
    try {
        return newton(flow, start, std::move(now), within);
    } catch (const Error &e) { // chatter, overflow, a singular I - M: no answer
        if (e.status() == PLM_CANCELLED || e.status() == PLM_ERR_MEMORY) throw;
        return {};
    }
}

Matrix MotionBeside::newton(ExactFlow &flow, const FlowState &start, FlowState now, const Matrix &within) {
    const FlowModel &model = flow.model();
    const EnergyNorm norm(flow);
    for (int k = 0; k < max_steps; ++k) {
        const PeriodRun run = run_periods(flow, now, periods_);
        Matrix matrix = plm::monodromy(model, run.intervals);
        FlowState next = moved(model, now, period_step(model, now, run, matrix, within), 1);
        const double step = run.size > 0 ? norm.distance(next, now) / run.size : 0;
        if (!std::isfinite(step) || norm.distance(next, start) > same_motion * run.size) return {};
        now = std::move(next);
        if (step > near_enough && step > safe_share * margin(matrix)) continue;
        keep_correction(model, start, now);
        return matrix;
    }
    return {};
}

void MotionBeside::keep_correction(const FlowModel &model, const FlowState &start, const FlowState &found) {
    correction_.clear();
    for (std::int64_t j = 0; j < model.n_moving(); ++j) correction_.push_back(found.y[j] - start.y[j]);
    for (std::int64_t j = 0; j < model.n_massive(); ++j) correction_.push_back(found.v[j] - start.v[j]);
}

} // namespace plm
