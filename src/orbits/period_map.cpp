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

namespace {

// Contact history, and the largest distance from the start at the ends of the pieces.
class RunRecorder final : public FlowRecorder {
  public:
    RunRecorder(const EnergyNorm &norm, const FlowState &start) : norm_(norm), start_(start), now_(start) {}
    void record(const FlowPiece &piece) override {
        history_.record(piece);
        const std::int64_t n = piece.coefficient.rows();
        std::fill(now_.y.begin(), now_.y.end(), 0.0);
        std::fill(now_.v.begin(), now_.v.end(), 0.0);
        for (std::int64_t k = 0; k < piece.coefficient.cols(); ++k)
            for (std::int64_t j = 0; j < n; ++j) {
                const double c = piece.coefficient(j, k);
                now_.y[j] += c;
                now_.v[j] += static_cast<double>(k) * c / piece.duration;
            }
        for (std::size_t k = 0; piece.fast && k < piece.fast->rate.size(); ++k) {
            const std::complex<double> rate = piece.fast->rate[k], turn = std::exp(rate * piece.duration);
            const double *a = piece.fast->cosine.col(static_cast<std::int64_t>(k)),
                         *b = piece.fast->sine.col(static_cast<std::int64_t>(k));
            for (std::int64_t j = 0; j < n; ++j) {
                const std::complex<double> q = std::complex<double>(a[j], b[j]) * turn;
                now_.y[j] += q.real();
                now_.v[j] += (rate * q).real();
            }
        }
        size_ = std::max(size_, norm_.distance(now_, start_));
    }
    bool only_polynomials() const override { return false; }
    double size() const { return size_; }
    const std::vector<ContactInterval> &intervals() const { return history_.intervals(); }

  private:
    const EnergyNorm &norm_;
    const FlowState &start_;
    FlowState now_;
    ContactHistory history_;
    double size_ = 0;
};

} // namespace

PeriodRun run_periods(ExactFlow &flow, const FlowState &start, std::int64_t periods) {
    const EnergyNorm norm(flow);
    RunRecorder recorder(norm, start);
    PeriodRun run;
    run.end = start;
    flow.advance(run.end, start.time + static_cast<double>(periods) * flow.period(), &recorder);
    run.distance = norm.distance(run.end, start);
    run.size = recorder.size();
    run.intervals = recorder.intervals();
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
