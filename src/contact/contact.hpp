// The contact of a model: stiffness and initial gap of every pair, and what its law (contact_law.hpp) makes
// of penetrations: states, forces, tangents, energy, and the springs of the linear system in which the pairs
// keep their states.
#pragma once
#include "contact/contact_law.hpp"
#include "contact/pair_states.hpp"

namespace plm {

/// Of pairs with these penetrations.
PairStates states_at(const vector<double> &u);

struct Contact {
    vector<double> stiffness;   // k_n of every pair
    vector<double> initial_gap; // g of every pair, < 0: interference

    std::int64_t n_pairs() const { return static_cast<std::int64_t>(stiffness.size()); }
    static constexpr std::int64_t n_directions = ContactLaw::n_directions; // of every pair
    /// Of the gap matrix: one for each direction of each pair, those of a pair together, its normal first.
    std::int64_t n_rows() const { return n_pairs() * n_directions; }
    static std::int64_t normal_row(std::int64_t pair) { return pair * n_directions; }
    /// u = -g: of the structure without loads, before contact moves it.
    vector<double> unloaded_penetration() const;
    /// Some pair presses without any load.
    bool has_interference() const;

    // u: penetration of every pair, along its normal
    double force(std::int64_t pair, double u) const { return ContactLaw::force(stiffness[pair], u); }
    double energy(std::int64_t pair, double u) const { return ContactLaw::energy(stiffness[pair], u); }
    vector<double> forces(const vector<double> &u) const;
    vector<double> tangents(const vector<double> &u) const;
    PairStates states(const vector<double> &u) const { return states_at(u); }
    PairStates states_of_forces(const vector<double> &forces) const { return states_at(forces); } // N > 0

    /// The linear system in which every pair keeps its state: its springs, 0 where there is none.
    vector<double> springs(const PairStates &states) const;
    /// Share of the period each pair is closed in a small motion about u: 1, 0, or 1/2 at zero.
    vector<double> closed_shares(const vector<double> &u) const;
    /// Share of the motion u of the pairs that keeps to the states, pressing pairs and parting ones each for
    /// themselves, those by their forces; the lesser of the two.
    double agreement(const PairStates &states, const vector<double> &u) const;
};

} // namespace plm
