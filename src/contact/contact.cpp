#include "contact/contact.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

static_assert(Contact::n_directions == 1, "what stands below has one number for each pair, along its normal");

vector<double> Contact::unloaded_penetration() const {
    vector<double> u(initial_gap.size());
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = -initial_gap[i];
    return u;
}

bool Contact::has_interference() const {
    return std::any_of(initial_gap.begin(), initial_gap.end(), [](double g) { return g < 0; });
}

vector<double> Contact::forces(const vector<double> &u) const {
    vector<double> n(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) n[i] = ContactLaw::force(stiffness[i], u[i]);
    return n;
}

vector<double> Contact::tangents(const vector<double> &u) const {
    vector<double> k(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) k[i] = ContactLaw::tangent(stiffness[i], u[i]);
    return k;
}

PairStates states_at(const vector<double> &u) {
    PairStates states = PairStates::all_open(static_cast<std::int64_t>(u.size()));
    for (std::int64_t i = 0; i < states.size(); ++i) states.set(i, ContactLaw::closed(u[i]));
    return states;
}

vector<double> Contact::springs(const PairStates &states) const {
    vector<double> spring(stiffness);
    for (std::int64_t i = 0; i < states.size(); ++i)
        if (!states.is_closed(i)) spring[i] = 0;
    return spring;
}

vector<double> Contact::closed_shares(const vector<double> &u) const {
    vector<double> share(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) share[i] = u[i] > 0 ? 1.0 : u[i] < 0 ? 0.0 : 0.5;
    return share;
}

double Contact::agreement(const PairStates &states, const vector<double> &u) const {
    double right[2] = {0, 0}, all[2] = {0, 0};
    for (std::int64_t i = 0; i < states.size(); ++i) {
        const bool closed = states.is_closed(i);
        const double amount = std::abs(u[i]) * (closed ? stiffness[i] : 1.0);
        all[closed] += amount;
        if (closed == ContactLaw::closed(u[i])) right[closed] += amount;
    }
    double least = 1;
    for (int c : {0, 1})
        if (all[c] > 0) least = std::min(least, right[c] / all[c]);
    return least;
}

} // namespace plm
