// L D L^T of a sparse symmetric matrix without pivoting, front by front (Duff and Reid, ACM Trans. Math.
// Softw. 9, 1983), at the price of a supernodal Cholesky factorization, whatever the signs of D. An
// eliminated front leaves its Schur complement to its parent; who wants the factor takes its columns as they
// come.
#pragma once
#include "structure/solver/matrix_sum.hpp"
#include <limits>

namespace plm {

/// The supernodes of L for some ordering, children before parents and each subtree in one piece (a
/// postorder). The arrays are the caller's.
struct Supernodes {
    std::int64_t count;
    const std::int64_t *first_column; // count + 1, in the new order
    const std::int64_t *first_row;    // count + 1, into `row`
    const std::int64_t *row;          // of each supernode, ascending: its columns, then the rows below them
    const std::int64_t *original;     // the row and column of the matrix for each one in the new order

    std::int64_t rows_of(std::int64_t node) const { return first_row[node + 1] - first_row[node]; }
    std::int64_t columns_of(std::int64_t node) const { return first_column[node + 1] - first_column[node]; }
};

/// A smaller pivot may have either sign: a share of the sum |a_jj| + sum |l_jk|^2 |d_k| it is subtracted
/// from. The computed pivots are those of A + E exactly, where E_jj is some roundings of that sum (Higham,
/// Accuracy and Stability of Numerical Algorithms, theorem 10.3, holds for D of any signs). Of a thousand
/// terms they add up to about the root of their number, 32.
constexpr double pivot_noise = 32 * std::numeric_limits<double>::epsilon();

/// Takes the columns of L and D of one supernode after the other.
class PanelTaker {
  public:
    virtual ~PanelTaker() = default;
    /// Where the panel of a supernode is to be computed; null: anywhere.
    virtual double *room(std::int64_t node) = 0;
    /// panel: rows_of(node) x columns_of(node), L below the diagonal, anything above; pivots: D.
    virtual void take(std::int64_t node, const double *panel, const double *pivots) = 0;
};

/// Eliminates all of `a` (both triangles stored, the supernodes those of its pattern); returns how many
/// eigenvalues are negative. PLM_ERR_SINGULAR with index() = column where a pivot is zero, NaN or not above
/// `least_pivot` of what it was subtracted from: its sign tells nothing then. Large fronts are shared out
/// among threads (linalg/parallel.hpp).
std::int64_t eliminate_fronts(const MatrixSum &a, const Supernodes &supernodes, PanelTaker *taker = nullptr,
                              double least_pivot = pivot_noise);

/// Entries of all panels, and of what the elimination holds beside them at once.
struct FrontSizes {
    std::int64_t panels = 0, at_work = 0;
};
FrontSizes front_sizes(std::int64_t n, const Supernodes &supernodes);

} // namespace plm
