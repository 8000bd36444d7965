// DOFs that nothing ever moves.
#pragma once
#include "structure/sparse.hpp"

namespace plm {

/// Alone in their rows of M, K and C, without contact and without load, so that their motion is zero whatever
/// the others do, and several with the same two numbers: supports that were left in the matrices as a number
/// on the diagonal. (One by itself may be a part of the structure, whose mode is asked for.)
struct StillDofs {
    vector<std::int64_t> dof; // of the caller
    double low_hz = 0,
           high_hz = 0; // what each would vibrate at, sqrt(K_ii / M_ii) / 2 pi; without mass: infinite
};

/// Of the columns of symmetric matrices: those with an entry off the diagonal are marked.
void mark_coupled(const SparseMatrix &a, vector<char> &moves);
/// Of those that are not marked. free_dof: the caller's numbers of the columns.
StillDofs still_dofs(const SparseMatrix &k, const SparseMatrix &m, const vector<char> &moves,
                     const vector<std::int64_t> &free_dof);

} // namespace plm
