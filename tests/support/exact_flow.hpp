// Independent truth for the tests: the exact piecewise-linear flow of a small structure with unilateral
// contact under a harmonic force, by matrix exponentials between contact events, and its periodic orbits by
// shooting. Shares no code with the library.
#pragma once
#include <functional>
#include <vector>

namespace exact {

/// M q'' + C q' + K q = F cos(omega t) + P - B' max(k (B q - g), 0); dense, row-major, n DOFs, z pairs.
struct Structure {
    int n = 0, z = 0;
    std::vector<double> mass;                   // n: diagonal
    std::vector<double> damping, stiffness;     // n x n
    std::vector<double> gap_rows;               // z x n
    std::vector<double> contact_stiffness, gap; // z
    std::vector<double> force, preload;         // n
};

/// One period of a motion: displacement samples of every DOF at equidistant times, and the orbit's extremes.
struct Orbit {
    bool converged = false;
    std::vector<double> start;                // 2n: q(0), q'(0)
    std::vector<std::vector<double>> samples; // [time][dof]
    double peak(int dof) const;               // max |q|, from samples refined by parabolas
};

/// State (2n) one forcing period after `start`; monodromy, if not null, receives the 2n x 2n derivative,
/// row-major. A contact that begins and ends within one of the n_steps is missed: a grazing one may be as
/// short.
std::vector<double> period_map(const Structure &s, double omega, const std::vector<double> &start,
                               std::vector<double> *monodromy, int n_steps = 200);

/// Periodic orbit of the forcing period by Newton on the Poincare map with the exact monodromy matrix, from
/// `guess` (2n, may be empty: zero) after `transient_periods` of marching.
Orbit periodic_orbit(const Structure &s, double omega, std::vector<double> guess, int transient_periods,
                     int n_samples);

} // namespace exact
