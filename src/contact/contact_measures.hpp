// What is told of the contact in a periodic motion. u: penetrations, Z x (2H + 1) coefficients.
#pragma once
#include "linalg/dense.hpp"

namespace plm {

/// Share of the period each pair is closed, from all zeros of its penetration.
vector<double> closed_shares(const Matrix &u);
/// How many times as large the oscillation of the penetrations about their means would have to be for the
/// first pair to switch; infinite where none moves.
double factor_to_switching(const Matrix &u);
/// The amplitude at which the first pair of a growing motion, rest + amplitude swing cos t, changes its
/// state. Pairs that do so at any amplitude (closed for half of the period at rest) are left out; 0: no other
/// one.
double amplitude_of_first_switch(const vector<double> &rest, const vector<double> &swing,
                                 const vector<double> &closed_shares);
/// <N u> / 2 over the period and all pairs: exact with N in the harmonics of u, since the others are
/// orthogonal to u.
double mean_energy(const Matrix &force, const Matrix &u);

} // namespace plm
