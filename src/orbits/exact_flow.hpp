// The exact flow of a reduced model under pre-load and harmonic excitation. Between two contact events the
// system is linear with constant coefficients: its Taylor series in time is summed to rounding (steps of at
// most two radians of the fastest motion), undamped resonance included, since nothing is divided by. On each
// piece the penetrations are polynomials, whose first zero is isolated, never sampled (polynomial.hpp). In a
// contact set that comes back often, the exponentials of its modes take the place of the series, and the
// pieces are as long as the slow modes allow (modal_pieces.hpp).
#pragma once
#include "contact/piece_events.hpp"
#include "linalg/monitor.hpp"
#include "orbits/contact_set.hpp"
#include "orbits/modal_pieces.hpp"
#include "orbits/monodromy.hpp"

namespace plm {

class ExactFlow {
  public:
    /// force_scale scales the excitation, not the pre-load. PLM_ERR_ARGUMENT unless omega > 0 and finite.
    /// `modes`: of the same model, shared by flows that pass the same contact sets; null: its own.
    ExactFlow(std::shared_ptr<const FlowModel> model, double omega, double force_scale, Watch watch = Watch(),
              std::shared_ptr<ContactModesKept> modes = nullptr);

    /// Advances the state to t_end >= state.time. A recorder, if any, sees every piece in order.
    /// PLM_ERR_CONVERGENCE with PLM_REASON_CONTACT_CHATTER and the pair as index when events follow each
    /// other without time going on, or when there are more of them than two of each pair per oscillation of
    /// the fastest motion, and some more; PLM_ERR_ARGUMENT for wrong sizes, NaN or Inf; PLM_CANCELLED.
    void advance(FlowState &state, double t_end, FlowRecorder *recorder = nullptr);

    /// From the next advance() on, which has to begin at time 0, `change` goes along: with x the state and
    /// its beginning kept, dx / d(force scale) = change; d x(fraction of the period) / d omega = change - (t
    /// / omega) x'(t).
    void differentiate(FlowParameter parameter);
    /// From then on, what is left out of the series of a piece, relative to the motion (to rounding at
    /// first); motions in the modes of a contact set stay as they are.
    void truncate(double part) { truncation_ = part; }
    const FlowState &change() const { return change_; }
    /// y'' of the coordinates with mass at a state that the last advance() led to.
    vector<double> acceleration(const FlowState &state);

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
    // A piece ends at the next event, or where its series or its modes do not reach further.
    void check(const FlowState &state, double t_end) const;
    void guess_contact(const FlowState &state);
    void fill_massless(FlowState &state); // in the present contact set
    double step_length(double left);
    double flops_of_piece() const;
    // Taylor series over one piece, in powers of its share.
    struct Series {
        Matrix coefficient, force, offset, still;
        PiecePenetrations penetrations;
    };
    void expand(const FlowState &state, double duration, Series &series);
    void expand_forces(double time, double duration, Series &series);
    void expand_change_of_loads(double time, double duration, Matrix &force) const;
    void expand_loads(double time, double duration, Matrix &force) const;
    std::int64_t n_force_terms() const;
    void expand_offsets(double time, double duration, Series &series);
    /// What acts on the pairs besides the moving coordinates has powers of the time.
    bool offsets_move() const { return model_->n_following() > 0 || model_->walls_move(); }
    vector<std::complex<double>> powers_of_load(bool changed, const LoadPart &part, double time,
                                                double duration, std::int64_t count) const;
    void follow(Series &series);
    void find_penetrations(Series &series);
    bool correct_sides(const FlowState &state, double duration, const PiecePenetrations &penetrations);
    void switch_pair(std::int64_t pair, double fraction, double time);
    void move_to(FlowState &state, double fraction, double duration, const Matrix &coefficient) const;
    void report(double start, double fraction, double duration, const Matrix &coefficient,
                const FastMotion *fast, FlowRecorder &recorder);
    void series_piece(FlowState &state, double left, FlowRecorder *recorder);
    bool modal_piece(FlowState &state, double left, FlowRecorder *recorder);
    bool goes_by_modes(FlowRecorder *recorder) const;
    bool may_stay(FlowRecorder *recorder) const;
    bool stay(FlowState &state, double left, FlowRecorder *recorder);
    double expected_end(const ContactModesKept::Stay &last) const;
    void end_stay(FlowState &state, double duration, std::int64_t pair, FlowRecorder *recorder);
    bool enter_modes(const FlowState &state);
    bool pass_on();
    void take_set();

    std::shared_ptr<const FlowModel> model_;
    double omega_, force_scale_;
    double fastest_force_ = 0; // rad/s, of the highest harmonic of the excitation
    Watch watch_;

    // The linear system of the present contact set: one whose modes are kept, or else the own one.
    ContactSet own_set_;
    std::shared_ptr<const ContactModes> taken_;
    const ContactSet *set_ = &own_set_; // of the last take_set()
    PieceEvents events_;                // which pair opens or closes next, and the states until then
    std::shared_ptr<ContactModesKept> modes_;

    FlowParameter parameter_ = FlowParameter::none; // that change_ is a derivative by
    FlowState change_;
    Series motion_, derivative_; // of the present piece, and of change_ on it

    // Working memory of a piece by its series: no piece allocates.
    Matrix contact_force_; // of the pairs
    Matrix shortened_;     // the series up to the event, as a recorder takes it
    Matrix known_;         // the first powers of the penetrations, by one pass over the gap rows
    const Matrix nothing_;
    vector<double> following_; // forces on the coordinates
    vector<double> ways_;      // how far the coordinates may go on the piece
    vector<double> now_;       // penetrations at its beginning
    vector<double> travel_;    // how far they may go
    std::unique_ptr<ModalPieces> modal_;
    bool may_use_modes_ = false;

    bool fresh_ = true; // an event has just been passed,
    bool dense_ = true; // and soon after the one before: modes do not pay for pieces so short
    double last_event_ = 0, shortest_series_ = 0; // times: of that event; of the longest step of a series
    double truncation_ = 1e-17;                   // see truncate()
    std::int64_t n_terms_ = 0;                    // of the series
    std::int64_t n_events_ = 0, n_steps_ = 0;
    std::int64_t event_limit_ = 0; // events that one period may have,
    std::int64_t stalled_ = 0;     // and how many in a row came without time going on: both end in an error
    Matrix here_, there_;          // penetrations and rates at the two ends of a stay in a contact set
    // Stays that were right at once, and those that an event cut short: where these are more, none is tried.
    std::int64_t n_stays_ = 0, n_lost_stays_ = 0;
    double events_left_ = 0; // of event_limit_ in this advance()
    double tried_ = 0;       // longest duration of the next piece
};

/// Keeps the sequence of contact sets, as monodromy() takes it.
class ContactHistory final : public FlowRecorder {
  public:
    void record(const FlowPiece &piece) override;
    bool only_polynomials() const override { return false; }
    bool needs_motion() const override { return false; }
    const std::vector<ContactInterval> &intervals() const { return intervals_; }
    void clear() { intervals_.clear(); }

  private:
    std::vector<ContactInterval> intervals_;
};

} // namespace plm
