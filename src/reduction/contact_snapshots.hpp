// A basis from statics: modes at rest, and what the contact forces of exact unilateral static solutions do to
// the structure.
#pragma once
#include "reduction/mode_selection.hpp"
#include "sampling/sampler.hpp"

namespace plm {

struct CollectedSnapshots {
    Matrix columns;                // space size x n, mass-normalised: modes at rest, then static vectors
    std::int64_t n_rest_modes = 0; // modes at rest among them
    std::int64_t n_solutions = 0;  // static solutions found
};

/// Basis of kind "snapshots". S is the system linearised about its contact status at rest; without pre-load
/// and gap there are two, the open and the sliding one, and the columns of both are taken.
///  1. Static solutions: minima of the unilateral problem (solve_static) under pre-load + alpha omega_d^2 M v
///     for each dominant mode v with its own frequency omega_d; this load is K_d v with the stiffness of the
///     mode's own linear system. options.n_snapshots values of alpha, half of each sign, are spaced
///     geometrically from 0.3 to 30 times the median size of the sweep's thresholds (the alpha at which the
///     linear estimate switches a pair). Homogeneous problems have only the two of alpha = -1 and 1.
///     A snapshot is the solution less the rest, of mass norm 1.
///  2. Modes of S up to rest_factor f_f. One is left out when the snapshots' contact forces beyond those of S
///     and the excitation, at any harmonic 0..H in the window and with 1 % of critical damping, move it by
///     less than snapshot_tolerance of a snapshot, energies compared: modes of another symmetry, mostly.
///  3. Of the snapshots and of the static responses of S to their inertia at H f_f (one step of a Krylov
///     sequence, which stands for the modes above rest_factor f_f) what is not in these modes, by its
///     singular values in the energy norm lambda + (2 pi f_f)^2, down to snapshot_tolerance of the largest.
/// dominant: coordinates of the dominant modes in this space. rest: in this space.
CollectedSnapshots collect_snapshots(const Space &space, const Sampler &sampler, const RestState &rest,
                                     const std::vector<vector<double>> &dominant, const SelectionRule &rule,
                                     const BasisOptions &options, Watch watch);

} // namespace plm
