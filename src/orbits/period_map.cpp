#include "orbits/period_map.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

double EnergyNorm::distance(const FlowState &a, const FlowState &b) const {
    double sum = 0;
    for (std::int64_t j = 0; j < model_.n_moving(); ++j) {
        const double dy = a.y[j] - b.y[j], dv = a.v[j] - b.v[j];
        sum += (model_.lambda()[j] + model_.mass(j) * omega_ * omega_) * dy * dy + model_.mass(j) * dv * dv;
    }
    return std::sqrt(sum);
}

PeriodRun run_periods(ExactFlow &flow, const FlowState &start, std::int64_t periods) {
    constexpr std::int64_t looks = 4; // at the distance from the start, in a period
    const EnergyNorm norm(flow);
    ContactHistory history;
    PeriodRun run;
    run.end = start;
    for (std::int64_t k = 1; k <= looks * periods; ++k) {
        flow.advance(run.end, start.time + static_cast<double>(k) / looks * flow.period(), &history);
        run.distance = norm.distance(run.end, start);
        run.size = std::max(run.size, run.distance);
    }
    run.intervals = history.intervals();
    return run;
}

vector<double> period_step(const FlowModel &model, const FlowState &start, const PeriodRun &run,
                           const Matrix &monodromy, const Matrix &within) {
    const std::int64_t n = model.state_size(), moving = model.n_moving();
    Matrix a(n, n);
    vector<double> step(n);
    for (std::int64_t j = 0; j < moving; ++j) step[j] = run.end.y[j] - start.y[j];
    for (std::int64_t j = 0; j < n - moving; ++j) step[moving + j] = run.end.v[j] - start.v[j];
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < n; ++i) a(i, j) = (i == j ? 1.0 : 0.0) - monodromy(i, j);
    RealLu lu;
    if (within.cols() == 0) {
        lu.factor(a);
        lu.solve(step.data(), 1, n);
        return step;
    }
    vector<double> part(within.cols());
    gemv('T', 1.0, within, step.data(), 0.0, part.data());
    Matrix inner = product('T', 'N', within, product('N', 'N', a, within));
    lu.factor(inner);
    lu.solve(part.data(), 1, within.cols());
    gemv('N', 1.0, within, part.data(), 0.0, step.data());
    return step;
}

FlowState moved(const FlowModel &model, const FlowState &state, const vector<double> &step, double factor) {
    FlowState next = state;
    const std::int64_t moving = model.n_moving();
    for (std::int64_t j = 0; j < moving; ++j) next.y[j] += factor * step[j];
    for (std::int64_t j = 0; j < model.n_massive(); ++j) next.v[j] += factor * step[moving + j];
    return next;
}

} // namespace plm
