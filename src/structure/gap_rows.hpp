// The gap matrix B over the free DOFs: row i gives the relative normal displacement of contact pair i.
#pragma once
#include "structure/field.hpp"
#include "structure/sparse.hpp"

namespace plm {

class GapRows {
  public:
    GapRows() = default;
    explicit GapRows(SparseMatrix matrix) : matrix_(std::move(matrix)) {}

    std::int64_t n_pairs() const { return matrix_.rows; }
    /// B V, Z x k.
    Matrix of(const Field &v) const;
    /// The same of one column, into u (Z).
    void of(const Field &v, vector<double> &u) const { multiply(matrix_, v.in_core().data(), u.data()); }
    /// What the terms of B V are before they cancel: |B| |V|.
    Matrix terms_of(const Field &v) const;
    /// B^T F, forces F (Z x k) on the DOFs.
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

    SparseMatrix matrix_; // Z x n_free
};

} // namespace plm
