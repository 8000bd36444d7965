// The contact of a model: stiffness and initial gap of every pair, and what its law (contact_law.hpp) makes
// of penetrations: states, forces, tangents, energy, and the springs of the linear system in which the pairs
// keep their states.
#pragma once
#include "contact/contact_law.hpp"
#include "contact/pair_states.hpp"
#include "linalg/dense.hpp"
#include "linalg/load_part.hpp"
#include <complex>
#include <map>

namespace plm {

/// Of pairs with these penetrations.
PairStates states_at(const vector<double> &u);

/// One part of the gaps' motion, omega^power Re((real + i imag) exp(i h omega t)); imag is empty where it is
/// zero, and pairs beyond the end stand still.
struct GapHarmonic {
    vector<double> real, imag;
};
using GapMotion = std::map<LoadPart, GapHarmonic>;

struct Contact {
    vector<double> stiffness;   // k_n of every pair
    vector<double> initial_gap; // g of every pair, < 0: interference
    GapMotion motion;           // of walls, which is excitation: times its scale it is added to the gap

    std::int64_t n_pairs() const { return static_cast<std::int64_t>(stiffness.size()); }
    static constexpr std::int64_t n_directions = ContactLaw::n_directions; // of every pair
    /// Of the gap matrix: one for each direction of each pair, those of a pair together, its normal first.
    std::int64_t n_rows() const { return n_pairs() * n_directions; }
    static std::int64_t normal_row(std::int64_t pair) { return pair * n_directions; }
    /// u = -g: of the structure without loads, before contact moves it.
    vector<double> unloaded_penetration() const;
    /// Some pair presses without any load.
    bool has_interference() const;

    /// Walls move.
    bool moves() const { return highest_motion() >= 0; }
    /// The highest harmonic in which they do; -1: none.
    int highest_motion() const;
    /// Complex amplitude of the gap of one pair in one harmonic.
    static std::complex<double> moved(const GapHarmonic &harmonic, std::int64_t pair);
    /// Their motion is another one at another frequency.
    bool moves_by_frequency() const;
    /// Fourier coefficients of the gaps, Z x (2H + 1): the initial ones and `scale` times their motion, over
    /// `multiple` periods of it; of the motion alone; and of its change by the frequency.
    Matrix gaps(std::int64_t n_harmonics, double omega, double scale, std::int64_t multiple = 1) const;
    Matrix gap_motion(std::int64_t n_harmonics, double omega, std::int64_t multiple = 1) const {
        return motion_by(&LoadPart::growth, n_harmonics, omega, multiple);
    }
    Matrix gap_motion_change(std::int64_t n_harmonics, double omega, std::int64_t multiple = 1) const {
        return motion_by(&LoadPart::growth_rate, n_harmonics, omega, multiple);
    }
    /// At a time; and their rates then.
    vector<double> gaps_at(double omega, double time, double scale) const;
    vector<double> gap_rates_at(double omega, double time, double scale) const;
    /// Through which moving walls act on the structure about these penetrations at rest: those of the pairs
    /// that touch; of all pairs, where none does.
    vector<double> wall_springs(const vector<double> &rest) const;
    /// These pairs alone; stiffness: theirs.
    Contact of_pairs(const vector<std::int64_t> &pairs, vector<double> stiffness) const;

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

  private:
    Matrix motion_by(double (LoadPart::*growth)(double) const, std::int64_t n_harmonics, double omega,
                     std::int64_t multiple) const;
};

} // namespace plm
