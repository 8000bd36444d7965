// The linear systems that contact leaves behind when every pair is replaced by a spring along its normal: a
// contact set (k_n or nothing), or the equivalent linear stiffnesses of linearisation methods.
#pragma once
#include "linalg/dense.hpp"

namespace plm {

/// Of a linear system in a space's coordinates: eigenvalues (rad^2/s^2) ascending, vectors m x count
/// mass-normalised; those below a limit, or all; then the directions without mass, too, of unit stiffness in
/// the coupled system: together they are its flexibility, sum of v v^T / value and of w w^T.
struct SpaceModes {
    vector<double> values;
    Matrix vectors;
    Matrix massless; // m x n_massless, when all are asked for
};

/// Modes of diag(lambda) + G^T diag(spring) G, ascending, mass-normalised; those below `upper` (rad^2/s^2),
/// or all when upper is infinite. lambda: m, >= 0, exactly 0 for rigid-body motion, ascending but for the
/// last n_massless, which have no mass; gap: G, Z x m; spring: Z, >= 0, 0: the pair is open. Exact zeros
/// remain of what no spring holds.
SpaceModes modes_with_springs(const vector<double> &lambda, std::int64_t n_massless, const Matrix &gap,
                              const vector<double> &spring, double upper);

/// X (m x n) becomes (diag(pivot) + G^T diag(spring) G)^-1 X. pivot: m, > 0; gap: G, Z x m; spring: Z, >= 0.
/// Throws PLM_ERR_SINGULAR when two pairs with infinite springs repeat the same gap row.
void solve_with_springs(const vector<double> &pivot, const Matrix &gap, const vector<double> &spring,
                        Matrix &x);
/// The same for one right-hand side.
void solve_with_springs(const vector<double> &pivot, const Matrix &gap, const vector<double> &spring,
                        vector<double> &x);

/// The forces of the springs (Z) in diag(lambda) + G^T diag(spring) G for one right-hand side: right to eps
/// however stiff they are. Rigid-body motion (lambda 0) that they do not hold is left out.
vector<double> spring_forces(const vector<double> &lambda, const Matrix &gap, const vector<double> &spring,
                             const vector<double> &x);

/// lambda with a tiny stiffness where there is none, so that rigid-body motion which contact alone holds, or
/// nothing, has a finite answer: 1e-10 of the first elastic one.
vector<double> held_pivots(const vector<double> &lambda);

} // namespace plm
