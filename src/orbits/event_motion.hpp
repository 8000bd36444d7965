// A periodic motion whose sequence of contact events is known, with the instants of these events. Between two
// events the motion is a steady response of the linear system of that contact set plus a free motion, which
// its exponential advances; no stiff mode dictates a step. The contact force is continuous at an event, so
// that a wrong instant changes the motion in the second order only: one step of Newton's method moves each
// event to the zero of its own penetration.
#pragma once
#include "contact/event_sequence.hpp"
#include "orbits/contact_set.hpp"
#include "orbits/monodromy.hpp"
#include <map>

namespace plm {

class EventMotion {
  public:
    /// within: see period_step().
    EventMotion(const FlowModel &model, double omega, double force_scale, std::int64_t periods,
                const Matrix &within);

    /// The periodic motion of the sequence with its instants as they are, and how far each event is from the
    /// zero of its penetration. False: none, or it is not finite.
    bool solve(const EventSequence &sequence);
    const Matrix &monodromy() const { return monodromy_; } // of that motion
    const FlowState &start() const { return start_; }
    double size() const { return size_; }   // largest distance from its start at the events, energy norm
    double shift() const { return shift_; } // largest of the events, as an angle of the excitation
    /// Whether the other pairs are at the events in the states that the sequence says.
    bool is_consistent() const { return consistent_; }
    /// The sequence with its events moved there; long moves are cut.
    EventSequence moved(const EventSequence &sequence) const;

  private:
    struct Steady; // response of the linear system of one contact set
    struct Whole { // displacements and velocities of all coordinates
        vector<double> y, v;
    };
    struct Piece {
        Matrix propagator;
        Whole before, after; // the steady response at its ends
    };
    Matrix stiffness_of(const vector<double> &springs) const;
    vector<std::complex<double>> wave(const Matrix &stiffness, const LoadPart &part, const HarmonicLoad &load,
                                      const vector<std::complex<double>> &wall_load) const;
    vector<std::complex<double>> wall_load(const vector<double> &springs, const LoadPart &part) const;
    const Steady *steady(const PairStates &states);
    Whole at(const Steady &steady, double time) const;
    vector<double> state_of(const Whole &whole) const;
    void pass(const Piece &piece, vector<double> &state) const;
    bool add_piece(const PairStates &states, double from, double to, vector<double> &offset);
    Matrix penetrations(const Whole &steady, const vector<double> &state, const PairStates &states,
                        double time);
    void look_at_event(const Matrix &u, const ContactEvent &event, const PairStates &states);

    const FlowModel &model_;
    double omega_, force_scale_, period_;
    const Matrix &within_;
    std::int64_t n_;
    ContactSet set_;
    std::map<PairStates, std::shared_ptr<Steady>> known_;
    std::vector<Piece> pieces_;
    Matrix monodromy_;
    FlowState start_;
    vector<double> shifts_;
    double size_ = 0, shift_ = 0;
    double largest_ = 0, worst_ = 0; // penetration; of a pair on the wrong side
    bool consistent_ = true;
};

} // namespace plm
