#include "contact/event_sequence.hpp"
#include "contact/penetration_zeros.hpp"
#include <algorithm>
#include <cmath>
#include <tuple>

namespace plm {

vector<char> EventSequence::acting() const {
    vector<char> acts(first.size());
    for (std::int64_t pair : first.closed_pairs()) acts[pair] = 1;
    for (const ContactEvent &event : events) acts[event.pair] = 1;
    return acts;
}

EventSequence EventSequence::moved(const vector<double> &shifts, double period) const {
    EventSequence next = *this;
    for (std::size_t k = 0; k < next.events.size(); ++k) {
        ContactEvent &event = next.events[k];
        event.time += shifts[k];
        if (event.time >= 0 && event.time <= period) continue;
        event.time += event.time < 0 ? period : -period;
        pass_event(next.first, event);
    }
    std::stable_sort(next.events.begin(), next.events.end(),
                     [](const ContactEvent &a, const ContactEvent &b) { return a.time < b.time; });
    return next;
}

EventSequence event_sequence(const Matrix &u, double period) {
    EventSequence sequence;
    if (u.rows() == 0) return sequence;
    SwitchingInstants switching = switching_instants(u);
    sequence.first = std::move(switching.first);
    for (std::int64_t i = 0; i < u.rows(); ++i)
        for (double t : switching.instants[i]) sequence.events.push_back({t / (2 * M_PI) * period, i});
    std::sort(sequence.events.begin(), sequence.events.end(),
              [](const ContactEvent &a, const ContactEvent &b) {
                  return std::tie(a.time, a.pair) < std::tie(b.time, b.pair);
              });
    return sequence;
}

double wrong_side(const PairStates &states, const double *u, std::int64_t except) {
    double worst = 0;
    for (std::int64_t i = 0; i < states.size(); ++i)
        if (i != except) worst = std::max(worst, states.is_closed(i) ? -u[i] : u[i]);
    return worst;
}

} // namespace plm
