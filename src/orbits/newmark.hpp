// Implicit time integration of the full sparse model with unilateral contact: Newmark's method with the
// alpha-damping of Hilber, Hughes and Taylor (1977); unconditionally stable, second order. One factorization
// of the step's matrix for the open structure serves all steps; contact enters through its flexibility
// (contact_step.hpp), whatever pairs are closed.
#pragma once
#include "contact/contact_step.hpp"
#include "linalg/monitor.hpp"
#include "space/model.hpp"
#include "structure/combination.hpp"

namespace plm {

struct NewmarkOptions {
    double force_scale = 1;              // scales the excitation, not the pre-load
    double alpha = 0;                    // 0 .. 1/3: numerical damping; 0 is the trapezoidal rule
    std::int64_t steps_per_period = 200; // >= 4
    std::int64_t max_periods = 100;
    double settled = 0; // stop when Settling::change() is below, states compared in the norm of M; 0: never
    std::int64_t period_multiple = 1; // periods of the excitation over which it is compared
};

/// The numbers of Newmark's rule.
struct NewmarkRule {
    NewmarkRule(const NewmarkOptions &options, double omega);
    double dt, beta, gamma, now; // now = 1 - alpha: weight of the forces at the end of a step
};

/// State over the free DOFs of the model, and time (s).
struct FullState {
    Field q, v; // one column each
    double time = 0;
};

/// What an observer sees after each step; valid during the call only.
struct NewmarkStep {
    double time;
    const Field &q, &v, &a;      // free DOFs
    const vector<double> &force; // N per pair
    const vector<double> &penetration;
};
class NewmarkObserver {
  public:
    virtual ~NewmarkObserver() = default;
    virtual void step(const NewmarkStep &step) = 0;
};

struct NewmarkResult {
    FullState state;
    std::int64_t periods = 0;
    bool settled = false;
    bool cancelled = false; // the state is then that of the last step done
    double change = -1;     // Settling::change()
    std::int64_t contact_iterations = 0, contact_factorizations = 0;
};

/// At rest under the pre-load.
FullState rest_state(const std::shared_ptr<const Model> &model, Watch watch = Watch());

class Newmark {
  public:
    /// omega: of the excitation (rad/s). Damping: Rayleigh and an explicit C as they are; structural damping
    /// by its viscous equivalent eta K / omega. PLM_ERR_ARGUMENT for modal damping, which has no
    /// sparse form.
    Newmark(std::shared_ptr<const Model> model, double omega, const NewmarkOptions &options,
            Watch watch = Watch());

    FullState rest() const { return rest_state(model_, watch_); }
    /// From a state (rest() by default) over whole periods of the excitation.
    NewmarkResult run(const FullState &start, NewmarkObserver *observer = nullptr);
    NewmarkResult run(NewmarkObserver *observer = nullptr) { return run(rest(), observer); }

  private:
    void find_flexibility();
    void excitation(double time, Field &f) const;
    void subtract_gaps(double time); // of u_free_
    void subtract_internal_forces(const Field &q, const Field &v, Field &f);
    void start(const FullState &state);
    void step(double time);
    double distance(const FullState &a, const FullState &b);

    std::shared_ptr<const Model> model_;
    double omega_;
    NewmarkRule rule_;
    NewmarkOptions options_;
    Watch watch_;
    Combination damping_, step_; // C, and S of a step
    Field response_;             // S^-1 B^T, n_free x Z
    std::unique_ptr<ContactStep> contact_;
    // state and work of a run
    FullState state_;
    Field a_, rest_force_, q_, v_, load_, work_;
    vector<double> u_free_, contact_force_;
};

} // namespace plm
