#include "orbits/full_motion.hpp"
#include "orbits/flow_model.hpp"
#include <chrono>
#include <cmath>

namespace plm {
namespace {

// Histories of the observed DOFs, and how often a pair has changed its state.
class RunObserver final : public NewmarkObserver {
  public:
    RunObserver(const Model &model, const FullState &start, const vector<double> &gaps,
                const vector<std::int64_t> &observed)
        : contact_(model.contact()) {
        for (std::int64_t dof : observed) rows_.push_back(model.terms(dof));
        vector<double> u(model.n_pairs());
        model.gap_rows().of(start.q, u);
        for (std::size_t i = 0; i < u.size(); ++i) u[i] -= gaps[i];
        before_ = contact_.states(u);
    }
    void step(const NewmarkStep &step) override {
        ++n_steps_;
        const PairStates states = contact_.states_of_forces(step.force);
        n_events_ += states.n_different(before_);
        before_ = states;
        for (const DofTerms &row : rows_) values_.push_back(step.q.at(row));
    }
    std::int64_t n_events() const { return n_events_; }
    std::int64_t n_steps() const { return n_steps_; }
    vector<double> &values() { return values_; }

  private:
    std::vector<DofTerms> rows_;
    const Contact &contact_;
    PairStates before_;
    vector<double> values_;
    std::int64_t n_events_ = 0, n_steps_ = 0;
};

NewmarkOptions newmark_options(const TransientOptions &o) {
    NewmarkOptions n;
    n.force_scale = o.force_scale;
    n.alpha = o.hht_alpha;
    n.steps_per_period = o.steps_per_period;
    n.max_periods = o.periods;
    n.settled = o.settled;
    n.period_multiple = o.period_multiple;
    return n;
}

} // namespace

NewmarkResult FullMotion::march(const NewmarkOptions &options, double omega, const FullState &start,
                                NewmarkObserver &observer, Watch watch) const {
    try {
        return Newmark(model_, omega, options, watch).run(start, &observer);
    } catch (const Error &e) { // stopped before the first step
        if (e.status() != status::cancelled) throw;
        NewmarkResult nothing;
        nothing.state = start;
        nothing.cancelled = true;
        return nothing;
    }
}

const FullState &FullMotion::present() {
    if (state_.q.empty()) state_ = rest_state(model_);
    return state_;
}

void FullMotion::set_state(const double *q, const double *v) {
    FullState state{q ? model_->restricted(q) : model_->zeros(1),
                    v ? model_->restricted(v) : model_->zeros(1), 0};
    state_ = std::move(state);
    restart_clock();
}

void FullMotion::start_at(const PointStart &start) {
    if (start.reduced->model != model_)
        throw Error(status::argument, "the branch is of another model; take one of this model")
            .argument("branch");
    const FlowModel recovery(start.reduced, 1.0); // coordinates do not depend on the frequency
    state_ = {recovery.field(start.state.y), recovery.field(start.state.v), 0};
    restart_clock();
}

void FullMotion::get_state(double *q, double *v) {
    const FullState &state = present();
    if (q) model_->expand(state.q, 0, q);
    if (v) model_->expand(state.v, 0, v);
}

TransientRun FullMotion::run(const TransientOptions &options, const vector<std::int64_t> &observed,
                             Watch watch) {
    const auto begin = std::chrono::steady_clock::now();
    const double omega = excitation_omega(options), period = 2 * M_PI / omega;
    FullState start = present();
    start.time = phase() * period;
    RunObserver observer(*model_, start, model_->contact().gaps_at(omega, start.time, options.force_scale),
                         observed);
    NewmarkResult found = march(newmark_options(options), omega, start, observer, watch);
    TransientRun run;
    run.cancelled = found.cancelled, run.settled = found.settled;
    run.periods = found.periods, run.change = found.change;
    run.n_events = observer.n_events(), run.contact_iterations = found.contact_iterations;
    run.observed = observed;
    run.values = std::move(observer.values());
    const double interval = period / static_cast<double>(options.steps_per_period);
    for (std::int64_t k = 1; k <= observer.n_steps() && !observed.empty(); ++k)
        run.time.push_back(time() + static_cast<double>(k) * interval);
    add_known_motion(*model_, options, run);
    const std::int64_t left = observer.n_steps() - found.periods * options.steps_per_period;
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    advance_clock(found.periods, static_cast<double>(left) * interval, period);
    state_ = std::move(found.state);
    return run;
}

PeriodicMotion FullMotion::find_periodic(const TransientOptions &, Watch) {
    throw Error(status::argument,
                "the periodic motion is found for reduced models only; create the transient "
                "with a basis, of kind full for the unreduced structure")
        .argument("transient");
}

} // namespace plm
