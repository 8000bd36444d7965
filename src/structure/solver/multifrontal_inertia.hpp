// The inertia of a sparse symmetric matrix at the price of a supernodal factorization: L D L^T without
// pivoting, front by front (Duff and Reid, ACM Trans. Math. Softw. 9, 1983). No factor is kept: an eliminated
// front leaves its Schur complement to its parent, and the signs of its pivots.
#pragma once
#include "structure/sparse.hpp"

namespace plm {

/// The supernodes of L for some ordering, children before parents and each subtree in one piece (a
/// postorder). The arrays are the caller's.
struct Supernodes {
    std::int64_t count;
    const std::int64_t *first_column; // count + 1, in the new order
    const std::int64_t *first_row;    // count + 1, into `row`
    const std::int64_t *row;          // of each supernode, ascending: its columns, then the rows below them
    const std::int64_t *original;     // the row and column of the matrix for each one in the new order
};

/// Negative eigenvalues of `a` (both triangles stored). PLM_ERR_SINGULAR with index() = column where a pivot
/// is nothing but rounding, so that its sign tells nothing.
std::int64_t count_negative_pivots(const SparseMatrix &a, const Supernodes &supernodes);

} // namespace plm
