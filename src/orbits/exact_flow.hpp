// The exact flow of a reduced model under pre-load and harmonic excitation. Between two contact events the
// system is linear with constant coefficients: its Taylor series in time is summed to rounding (steps of at
// most two radians of the fastest motion), undamped resonance included, since nothing is divided by. On each
// piece the penetrations are polynomials, whose first zero is isolated, never sampled (polynomial.hpp).
#pragma once
#include "contact/piece_events.hpp"
#include "linalg/monitor.hpp"
#include "orbits/contact_set.hpp"
#include "orbits/monodromy.hpp"

namespace plm {

/// One piece of the motion: y(start + s duration) = sum_k coefficient(:, k) s^k for s in [0, 1], with one
/// contact set. Valid during the call of the recorder only.
struct FlowPiece {
    double start, duration;
    const Matrix &coefficient; // n x (degree + 1)
    const PairStates &states;
};

class FlowRecorder {
  public:
    virtual ~FlowRecorder() = default;
    virtual void record(const FlowPiece &piece) = 0;
};

class ExactFlow {
  public:
    /// force_scale scales the excitation, not the pre-load. PLM_ERR_ARGUMENT unless omega > 0 and finite.
    ExactFlow(std::shared_ptr<const FlowModel> model, double omega, double force_scale,
              Watch watch = Watch());

    /// Advances the state to t_end >= state.time. A recorder, if any, sees every piece in order.
    /// PLM_ERR_CONVERGENCE with PLM_REASON_CONTACT_CHATTER and the pair as index when events follow each
    /// other without time going on, or when there are more of them than two of each pair per oscillation of
    /// the fastest motion, and some more; PLM_ERR_ARGUMENT for wrong sizes, NaN or Inf; PLM_CANCELLED.
    void advance(FlowState &state, double t_end, FlowRecorder *recorder = nullptr);

    /// Gives the coordinates without mass what the others and the forces make of them: velocities, and the
    /// displacements of those that follow at once.
    void complete(FlowState &state);

    const FlowModel &model() const { return *model_; }
    double omega() const { return omega_; }
    double force_scale() const { return force_scale_; }
    double period() const { return 2 * M_PI / omega_; }
    std::int64_t n_events() const { return n_events_; } // since construction
    std::int64_t n_steps() const { return n_steps_; }

  private:
    void check(const FlowState &state, double t_end) const;
    void guess_contact(const FlowState &state);
    double step_length(double left);
    double flops_of_piece() const;
    void expand(const FlowState &state, double duration);
    void expand_forces(double time, double duration);
    void expand_offsets();
    void follow();
    bool correct_sides(const FlowState &state, double duration);
    void switch_pair(std::int64_t pair, double fraction, double time);
    void move_to(FlowState &state, double fraction, double duration);
    void report(const FlowState &state, double fraction, double duration, FlowRecorder &recorder);

    std::shared_ptr<const FlowModel> model_;
    double omega_, force_scale_, fastest_force_ = 0;
    Watch watch_;
    ContactSet system_;
    PieceEvents events_;
    Matrix coefficient_, force_, offset_, still_, penetration_, contact_force_, shortened_;
    vector<double> following_;
    std::int64_t n_terms_ = 0, n_events_ = 0, n_steps_ = 0, event_limit_ = 0, stalled_ = 0;
    double events_left_ = 0;
};

/// Keeps the sequence of contact sets, as monodromy() takes it.
class ContactHistory final : public FlowRecorder {
  public:
    void record(const FlowPiece &piece) override;
    const std::vector<ContactInterval> &intervals() const { return intervals_; }
    void clear() { intervals_.clear(); }

  private:
    std::vector<ContactInterval> intervals_;
};

/// max |row . y| over the motion for each row of a matrix (rows x n): extrema between the events are
/// found exactly, not sampled.
class PeakRecorder final : public FlowRecorder {
  public:
    explicit PeakRecorder(Matrix rows) : rows_(std::move(rows)), peak_(rows_.rows(), 0.0) {}
    void record(const FlowPiece &piece) override;
    const vector<double> &peak() const { return peak_; }

  private:
    Matrix rows_, values_;
    vector<double> peak_, polynomial_;
};

} // namespace plm
