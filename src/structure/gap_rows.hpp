// The gap matrix B over the free DOFs: each row gives the relative displacement of a contact pair in one of
// the directions in which it acts.
#pragma once
#include "structure/field.hpp"
#include "structure/sparse.hpp"

namespace plm {

/// The rows of a pair follow one another, its normal first.
struct GapSize {
    std::int64_t n_pairs = 0, n_directions = 1;
    std::int64_t n_rows() const { return n_pairs * n_directions; }
    std::int64_t pair_of(std::int64_t row) const { return row / n_directions; }
};

class GapRows {
  public:
    GapRows() = default;
    /// n_rows() x n_free.
    GapRows(SparseMatrix matrix, GapSize size) : matrix_(std::move(matrix)), size_(size) {}

    std::int64_t n_rows() const { return size_.n_rows(); }
    /// B V, n_rows() x k.
    Matrix of(const Field &v) const;
    /// The same of one column, into u.
    void of(const Field &v, vector<double> &u) const { multiply(matrix_, v.in_core().data(), u.data()); }
    /// What the terms of B V are before they cancel: |B| |V|.
    Matrix terms_of(const Field &v) const;
    /// B^T F, forces F (n_rows() x k) on the DOFs.
    Field forces(const Matrix &f) const;
    /// B^T.
    Field columns() const;

    struct Term {
        std::int64_t dof; // free index
        double coefficient;
    };
    /// Rows as lists of their terms, by ascending DOF.
    std::vector<vector<Term>> rows() const;
    /// Free indices of the DOFs that some of these pairs hold, ascending.
    vector<std::int64_t> dofs_of(const vector<std::int64_t> &pairs) const;
    vector<std::int64_t> dofs() const;

    /// For this room, and for tests.
    const SparseMatrix &matrix() const { return matrix_; }

  private:
    vector<std::int64_t> dofs_where(const vector<char> &chosen) const;

    SparseMatrix matrix_; // n_rows() x n_free
    GapSize size_;
};

} // namespace plm
