#include "orbits/reduced_motion.hpp"
#include "orbits/instant_recorder.hpp"
#include "orbits/settling.hpp"
#include "orbits/shooting.hpp"
#include "reduction/reduced_rest.hpp"
#include "reduction/widened_model.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>

namespace plm {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

// In the norm of M, velocities against displacements as for the excitation's frequency; without mass in that
// of K.
double distance(const FlowModel &model, const FlowState &a, const FlowState &b, double omega) {
    double sum = 0;
    for (std::int64_t j = 0; j < model.n_moving(); ++j) {
        const double dy = a.y[j] - b.y[j], dv = a.v[j] - b.v[j], m = model.mass(j);
        sum += (m > 0 ? omega * omega : model.lambda()[j]) * dy * dy + m * dv * dv;
    }
    return std::sqrt(sum);
}

} // namespace

// The flow's time is set back after each period: whole periods do not matter to the excitation, and the
// rounding of the time stays small.
class ReducedMotion::March {
    // Hands on the progress of one piece of a run as progress of the run.
    class Progress final : public Monitor {
      public:
        Progress(Watch watch, double n_pieces) : watch_(watch), n_pieces_(n_pieces) {}
        void log(int level, const std::string &text) override { watch_.log(level, text); }
        bool progress(const char *stage, double fraction) override {
            return watch_.cancelled(stage, (done_ + fraction) / n_pieces_);
        }
        void next() { ++done_; }

      private:
        Watch watch_;
        double n_pieces_, done_ = 0;
    };

  public:
    March(std::shared_ptr<const FlowModel> model, const TransientOptions &options, FlowState state,
          Matrix observed, Watch watch)
        : options_(options), progress_(watch, 4 * static_cast<double>(options.periods)),
          flow_(std::move(model), excitation_omega(options), options.force_scale, Watch(&progress_)),
          settling_(options.settled, options.period_multiple), state_(std::move(state)), before_(state_),
          begin_(state_.time),
          recorder_(std::move(observed), flow_.period() / static_cast<double>(options.steps_per_period)) {}

    void run() {
        try {
            while (periods_ < options_.periods && !settling_.settled()) period();
        } catch (const Error &e) {
            if (e.status() != status::cancelled) throw;
            cancelled_ = true;
        }
    }

    TransientRun result(double time) {
        TransientRun run;
        run.cancelled = cancelled_, run.settled = settling_.settled();
        run.periods = periods_, run.change = settling_.change();
        run.n_events = recorder_.n_events();
        run.values = recorder_.take_values();
        const double interval = period_length() / static_cast<double>(options_.steps_per_period);
        for (std::int64_t k = 1; k <= recorder_.n_instants(); ++k)
            run.time.push_back(time + static_cast<double>(k) * interval);
        return run;
    }

    FlowState &state() { return state_; }
    double period_length() const { return flow_.period(); }
    std::int64_t periods() const { return periods_; }
    double part() const { return state_.time - begin_; } // of a period that was not finished

  private:
    void period() {
        for (int quarter = 1; quarter <= 4; ++quarter, progress_.next()) {
            Watch(&progress_).step("exact flow", 0.0);
            recorder_.continue_at(static_cast<double>(periods_) * flow_.period() + part());
            flow_.advance(state_, begin_ + 0.25 * quarter * flow_.period(), &recorder_);
            if (settling_.quarter(distance(flow_.model(), state_, before_, flow_.omega()))) before_ = state_;
        }
        state_.time = begin_;
        ++periods_;
    }

    const TransientOptions &options_;
    Progress progress_;
    ExactFlow flow_;
    Settling settling_;
    FlowState state_, before_;
    double begin_;
    InstantRecorder recorder_;
    std::int64_t periods_ = 0;
    bool cancelled_ = false;
};

ReducedMotion::ReducedMotion(std::shared_ptr<const ReducedModel> reduced)
    : reduced_(std::move(reduced)), model_omega_(1) { // coordinates do not depend on the frequency
    flow_model_ = std::make_shared<const FlowModel>(reduced_, model_omega_);
}

void ReducedMotion::use_frequency(double omega) {
    if (reduced_->structural == 0 || omega == model_omega_) return;
    flow_model_ = std::make_shared<const FlowModel>(reduced_, omega);
    model_omega_ = omega;
}

// At rest under the pre-load when nothing else was set.
const FlowState &ReducedMotion::present() {
    if (state_.y.empty()) {
        state_ = {flow_model_->from_static_coordinates(rest_of(*reduced_)->coordinates),
                  vector<double>(size(), 0.0), 0};
    }
    return state_;
}

void ReducedMotion::set_state(const double *q, const double *v) {
    const Model &model = *reduced_->model;
    FlowState state{vector<double>(size(), 0.0), vector<double>(size(), 0.0), 0};
    const auto project = [&](const double *all, vector<double> &coordinates) {
        if (!all) return;
        const Matrix c = static_coordinates_of(*reduced_, model.restricted(all));
        coordinates = flow_model_->from_static_coordinates(vector<double>(c.data(), c.data() + size()));
    };
    project(q, state.y);
    project(v, state.v);
    state_ = std::move(state);
    restart_clock();
}

void ReducedMotion::start_at(const PointStart &start) {
    if (!of_one_basis(start.reduced, reduced_))
        throw Error(status::argument,
                    "the branch was computed on another basis, or before the basis was built "
                    "anew; take one of this basis, or make a transient without a basis")
            .argument("branch");
    state_ = start.state;
    restart_clock();
}

void ReducedMotion::get_state(double *q, double *v) {
    const FlowState &state = present();
    if (q) reduced_->model->expand(flow_model_->field(state.y), 0, q);
    if (v) reduced_->model->expand(flow_model_->field(state.v), 0, v);
}

Matrix ReducedMotion::dof_rows(const vector<std::int64_t> &dofs) const {
    Matrix rows(static_cast<std::int64_t>(dofs.size()), size());
    for (std::int64_t i = 0; i < rows.rows(); ++i) {
        const vector<double> row = flow_model_->dof_row(dofs[i]);
        for (std::int64_t j = 0; j < size(); ++j) rows(i, j) = row[j];
    }
    return rows;
}

TransientRun ReducedMotion::run(const TransientOptions &options, const vector<std::int64_t> &observed,
                                Watch watch) {
    const Clock::time_point begin = Clock::now();
    const double omega = excitation_omega(options);
    use_frequency(omega);
    FlowState start = present();
    start.time = phase() * 2 * M_PI / omega;
    March march(flow_model_, options, std::move(start), dof_rows(observed), watch);
    march.run();
    TransientRun run = march.result(time());
    run.observed = observed;
    if (reduced_->model) add_known_motion(*reduced_->model, options, run);
    run.seconds = seconds_since(begin);
    advance_clock(march.periods(), march.part(), march.period_length());
    state_ = std::move(march.state());
    return run;
}

PeriodicMotion ReducedMotion::find_periodic(const TransientOptions &options, Watch watch) {
    const Clock::time_point begin = Clock::now();
    const double omega = excitation_omega(options);
    use_frequency(omega);
    ExactFlow flow(flow_model_, omega, options.force_scale, watch);
    FlowState start = present();
    start.time = phase() * flow.period();
    PeriodicOrbit orbit = periodic_orbit(
        flow, start,
        {options.period_multiple, 0, options.tolerance, options.max_iterations, options.march_when_stuck});
    state_ = std::move(orbit.state);
    return {orbit.converged, orbit.iterations, orbit.defect, std::move(orbit.multipliers),
            seconds_since(begin)};
}

} // namespace plm
