// Motion in time as a host asks for it: a state, runs of whole periods of the excitation with some DOFs
// observed, and the periodic motion nearby. Two engines: the exact flow of a reduced model and Newmark's
// method for the full one.
#pragma once
#include "linalg/monitor.hpp"
#include "orbits/flow_model.hpp"
#include <complex>

namespace plm {

struct TransientOptions {
    double frequency_hz = 0;             // of the excitation; must be set
    double force_scale = 1;              // scales the excitation, not the pre-load
    std::int64_t periods = 100;          // of a run, of the excitation
    std::int64_t period_multiple = 1;    // excitation periods in a period of the motion
    double settled = 0;                  // a run ends when Settling::change() is below; 0: never
    std::int64_t steps_per_period = 200; // instants recorded; of the full model also the steps
    double hht_alpha = 0;                // full model: numerical damping, 0 .. 1/3
    double tolerance = 1e-11;            // of the periodicity defect of find_periodic()
    std::int64_t max_iterations = 30;    // of find_periodic()
    bool march_when_stuck = false;       // see ShootingOptions
};

/// rad/s; PLM_ERR_STATE when no frequency is set.
double excitation_omega(const TransientOptions &options);

/// What a run leaves besides the state.
struct TransientRun {
    bool cancelled = false, settled = false;
    std::int64_t periods = 0; // whole ones
    double change = -1;       // Settling::change()
    std::int64_t n_events = 0, contact_iterations = 0;
    vector<std::int64_t> observed; // DOFs, base 0
    vector<double> time, values;   // instants (s); per instant one displacement for each observed DOF
    double seconds = 0;
};

/// What find_periodic() leaves besides the state.
struct PeriodicMotion {
    bool converged = false;
    std::int64_t iterations = 0;
    double defect = 0;                        // periodicity_defect()
    vector<std::complex<double>> multipliers; // largest modulus first
    double seconds = 0;
};

/// The beginning of the period of a point of a curve: a state of the flow of its reduced model.
struct PointStart {
    std::shared_ptr<const ReducedModel> reduced;
    FlowState state;
};

/// Starts at rest under the pre-load. Nothing changes where a member throws; a cancelled run has kept what it
/// marched.
class Transient {
  public:
    virtual ~Transient() = default;

    virtual bool is_reduced() const = 0;
    virtual std::int64_t size() const = 0; // coordinates marched
    /// Time since the first state (s).
    double time() const { return time_; }

    /// Over all DOFs of the model (n_dof), null for zero, at the beginning of a period; the time is 0 again.
    virtual void set_state(const double *q, const double *v) = 0;
    /// The state of a point at the beginning of its period. Reduced models take their own points only.
    virtual void start_at(const PointStart &start) = 0;
    /// Over all DOFs (n_dof), each may be null.
    virtual void get_state(double *q, double *v) = 0;

    /// observed: DOFs, base 0. PLM_ERR_STATE without a frequency.
    virtual TransientRun run(const TransientOptions &options, const vector<std::int64_t> &observed,
                             Watch watch) = 0;
    /// PLM_ERR_ARGUMENT for a full model.
    virtual PeriodicMotion find_periodic(const TransientOptions &options, Watch watch) = 0;

  protected:
    /// To the observed DOFs, whatever of them is known beside the motion marched.
    void add_known_motion(const Model &model, const TransientOptions &options, TransientRun &run) const;
    /// A new first state.
    void restart_clock() { time_ = phase_ = 0; }
    /// After `periods` whole periods of the given length, then a part of one.
    void advance_clock(std::int64_t periods, double part, double period);
    double phase() const { return phase_; } // share of a period of the excitation, in [0, 1)

  private:
    double time_ = 0, phase_ = 0;
};

} // namespace plm
