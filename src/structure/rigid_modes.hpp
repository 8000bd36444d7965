// The factorization every other room uses: K when it is positive definite, else K + sigma M with the
// rigid-body modes that make K singular.
#pragma once
#include "linalg/monitor.hpp"
#include "structure/field.hpp"
#include "structure/solver/factor.hpp"

namespace plm {

struct FactoredStiffness {
    std::unique_ptr<TallFactor> factor; // of K + shift M
    double shift = 0;                   // 0 when K is positive definite
    Field rigid_modes;                  // M-orthonormal, n x count
    double uncertainty = 0;             // of the first elastic eigenvalue by rounding of K, relative
};

/// `largest_contact` (0 if unknown) sets the scale of sigma when K is zero altogether. `free_dof` translates
/// columns to the caller's DOFs in error texts. Throws PLM_ERR_NOT_POSITIVE_DEFINITE when K has a negative
/// eigenvalue or a mass-less DOF can move freely.
FactoredStiffness factor_with_rigid_modes(const Tall &structure, double largest_contact,
                                          const vector<std::int64_t> &free_dof, const Solver &solver,
                                          Watch watch);

} // namespace plm
