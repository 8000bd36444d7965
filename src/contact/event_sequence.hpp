// A periodic motion by its contact: the states at its beginning and when which pair changes its own.
#pragma once
#include "contact/contact_force.hpp"

namespace plm {

struct ContactEvent {
    double time; // s, within the period of the motion
    std::int64_t pair;
};

/// What the states become at an event.
inline void pass_event(PairStates &states, const ContactEvent &event) {
    states.switch_pair(event.pair);
}

struct EventSequence {
    PairStates first; // at time 0
    std::vector<ContactEvent> events;

    /// Z flags: the pair presses at some time.
    vector<char> acting() const;
    /// Each event later by its shift (s). One that leaves the period comes in at its other end: its pair then
    /// is in the other state at time 0.
    EventSequence moved(const vector<double> &shifts, double period) const;
};

/// Of the pairs with penetrations u (Z x (2H + 1) coefficients), all zeros found.
EventSequence event_sequence(const Matrix &u, double period);

/// How far a pair other than `except` is on the side of zero where its state does not belong; 0: none is.
double wrong_side(const PairStates &states, const double *u, std::int64_t except);

} // namespace plm
