#include "transient/shooting.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double least_damping = 1.0 / 64;
constexpr std::int64_t first_march = 4; // periods; doubled each time

class EnergyNorm {
  public:
    explicit EnergyNorm(const ExactFlow &flow) : model_(flow.model()), omega_(flow.omega()) {}
    // What follows is no state.
    double distance(const FlowState &a, const FlowState &b) const {
        double sum = 0;
        for (std::int64_t j = 0; j < model_.n_moving(); ++j) {
            const double dy = a.y[j] - b.y[j], dv = a.v[j] - b.v[j];
            sum +=
                (model_.lambda()[j] + model_.mass(j) * omega_ * omega_) * dy * dy + model_.mass(j) * dv * dv;
        }
        return std::sqrt(sum);
    }

  private:
    const FlowModel &model_;
    double omega_;
};

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
        size_ = std::max(size_, norm_.distance(now_, start_));
    }
    double size() const { return size_; }
    const std::vector<ContactInterval> &intervals() const { return history_.intervals(); }

  private:
    const EnergyNorm &norm_;
    const FlowState &start_;
    FlowState now_;
    ContactHistory history_;
    double size_ = 0;
};

// One run over the orbit from a state.
struct Run {
    FlowState end;
    double distance = 0, size = 0;
    std::vector<ContactInterval> intervals;
    double defect() const { return size > 0 ? distance / size : 0.0; }
};

Run run_once(ExactFlow &flow, const FlowState &start, std::int64_t periods) {
    const EnergyNorm norm(flow);
    RunRecorder recorder(norm, start);
    Run run;
    run.end = start;
    flow.advance(run.end, start.time + static_cast<double>(periods) * flow.period(), &recorder);
    run.distance = norm.distance(run.end, start);
    run.size = recorder.size();
    run.intervals = recorder.intervals();
    return run;
}

// (I - M) step = end - start
vector<double> newton_step(const FlowModel &model, const FlowState &start, const Run &run) {
    const std::int64_t n = model.state_size(), moving = model.n_moving();
    Matrix a = monodromy(model, run.intervals);
    vector<double> step(n);
    for (std::int64_t j = 0; j < moving; ++j) step[j] = run.end.y[j] - start.y[j];
    for (std::int64_t j = 0; j < n - moving; ++j) step[moving + j] = run.end.v[j] - start.v[j];
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < n; ++i) a(i, j) = (i == j ? 1.0 : 0.0) - a(i, j);
    RealLu lu;
    lu.factor(a);
    lu.solve(step.data(), 1, n);
    return step;
}

FlowState moved(const FlowModel &model, const FlowState &state, const vector<double> &step, double factor) {
    FlowState next = state;
    const std::int64_t moving = model.n_moving();
    for (std::int64_t j = 0; j < moving; ++j) next.y[j] += factor * step[j];
    for (std::int64_t j = 0; j < model.n_massive(); ++j) next.v[j] += factor * step[moving + j];
    return next;
}

void check(const ShootingOptions &o) {
    if (o.period_multiple < 1 || o.transient_periods < 0 || !(o.tolerance > 0) || o.max_iterations < 0)
        throw Error(PLM_ERR_ARGUMENT, "shooting needs period_multiple >= 1, transient_periods >= 0, "
                                      "tolerance > 0 and max_iterations >= 0")
            .argument("options");
}

// Whole periods do not matter to the excitation: times are kept small, and with them their rounding.
double phase_time(const ExactFlow &flow, double time) {
    return time - std::floor(time / flow.period()) * flow.period();
}

// Time is set back, since whole periods do not matter to the excitation.
void march(ExactFlow &flow, FlowState &state, std::int64_t periods) {
    const double begin = state.time;
    for (std::int64_t k = 0; k < periods; ++k) {
        flow.advance(state, begin + flow.period());
        state.time = begin;
    }
}

// One step of Newton's method, shortened until the state at the end comes closer to that at the start: along
// the step it does, unless the contact events change too much. False: nothing has changed.
bool improve(ExactFlow &flow, std::int64_t periods, FlowState &state, Run &run) {
    const vector<double> step = newton_step(flow.model(), state, run);
    for (double factor = 1; factor >= least_damping; factor *= 0.5) {
        FlowState next = moved(flow.model(), state, step, factor);
        Run next_run = run_once(flow, next, periods);
        if (!(next_run.distance < (1 - 0.25 * factor) * run.distance)) continue;
        state = std::move(next);
        run = std::move(next_run);
        return true;
    }
    return false;
}

void keep_closer(const Run &run, const FlowState &state, Run &best, PeriodicOrbit &orbit) {
    if (!best.end.y.empty() && !(run.defect() < best.defect())) return;
    best = run;
    orbit.state = state;
    orbit.defect = run.defect();
}

} // namespace

PeriodicOrbit periodic_orbit(ExactFlow &flow, const FlowState &start, const ShootingOptions &options) {
    check(options);
    FlowState state = start;
    state.time = phase_time(flow, start.time);
    march(flow, state, options.transient_periods);
    PeriodicOrbit orbit;
    orbit.period_multiple = options.period_multiple;
    Run run = run_once(flow, state, orbit.period_multiple), best;
    keep_closer(run, state, best, orbit);
    std::int64_t patience = first_march;
    while (orbit.iterations < options.max_iterations && orbit.defect > options.tolerance) {
        ++orbit.iterations;
        if (!improve(flow, orbit.period_multiple, state, run)) {
            if (!options.march_when_stuck) break;
            march(flow, state, patience * orbit.period_multiple);
            patience *= 2;
            run = run_once(flow, state, orbit.period_multiple);
        }
        keep_closer(run, state, best, orbit);
    }
    flow.complete(orbit.state);
    orbit.converged = orbit.defect <= options.tolerance;
    orbit.multipliers = multipliers(monodromy(flow.model(), best.intervals));
    orbit.contact_history = std::move(best.intervals);
    return orbit;
}

double periodicity_defect(ExactFlow &flow, const FlowState &state, std::int64_t period_multiple) {
    if (period_multiple < 1)
        throw Error(PLM_ERR_ARGUMENT, "period_multiple must be at least 1").argument("period_multiple");
    return run_once(flow, state, period_multiple).defect();
}

vector<double> orbit_peaks(ExactFlow &flow, const PeriodicOrbit &orbit, const Matrix &rows) {
    if (rows.cols() != flow.model().size())
        throw Error(PLM_ERR_ARGUMENT, "the rows do not fit the coordinates of the flow").argument("rows");
    PeakRecorder recorder(rows);
    FlowState state = orbit.state;
    flow.advance(state, state.time + static_cast<double>(orbit.period_multiple) * flow.period(), &recorder);
    return recorder.peak();
}

} // namespace plm
