// The gap matrix B over the free DOFs: each row gives the relative displacement of a contact pair in one of
// the directions in which it acts.
#pragma once
#include "structure/field.hpp"
#include "structure/sparse.hpp"

namespace plm {

class ByteReader;
class ByteWriter;

/// The rows of a pair follow one another, its normal first.
struct GapSize {
    std::int64_t n_pairs = 0, n_directions = 1;
    std::int64_t n_rows() const { return n_pairs * n_directions; }
    std::int64_t pair_of(std::int64_t row) const { return row / n_directions; }
};

class GapRows {
  public:
    GapRows() = default;
    /// n_rows() x n_free, in core. place: no columns, where those are that the rows are taken of.
    GapRows(SparseMatrix matrix, GapSize size) : matrix_(std::move(matrix)), size_(size) {
        place_ = Field(matrix_.cols, 0);
    }
    GapRows(SparseMatrix matrix, GapSize size, Field place)
        : matrix_(std::move(matrix)), size_(size), place_(std::move(place)) {}

    std::int64_t n_rows() const { return size_.n_rows(); }
    const GapSize &size() const { return size_; }
    /// B V, n_rows() x k.
    Matrix of(const Field &v) const;
    /// The same of one column, into u.
    void of(const Field &v, vector<double> &u) const;
    /// What the terms of B V are before they cancel: |B| |V|.
    Matrix terms_of(const Field &v) const;
    /// From here on B is what it was less its part along rigid-body motions R_0 (M-orthonormal; momenta:
    /// M R_0), as rows that balance with the structure's inertia: B - (B R_0) (M R_0)^T. Their terms stay.
    void leave_out(const Field &motions, Field momenta);

    /// B^T F, forces F (n_rows() x k) on the DOFs.
    Field forces(const Matrix &f) const;
    /// B^T.
    Field columns() const;

    /// Rows as lists of their terms, by ascending DOF.
    std::vector<DofTerms> rows() const;
    /// Free indices of the DOFs that some of these pairs hold, ascending.
    vector<std::int64_t> dofs_of(const vector<std::int64_t> &pairs) const;
    vector<std::int64_t> dofs() const;

    void write(ByteWriter &bytes) const;
    void read(ByteReader &bytes, std::int64_t n_free);

    /// The terms alone: for this room, and for tests.
    const SparseMatrix &matrix() const { return matrix_; }

  private:
    template <class Rows, class Bytes> static void pass(Rows &rows, std::int64_t n_free, Bytes &bytes);
    vector<std::int64_t> dofs_where(const vector<char> &chosen) const;

    SparseMatrix matrix_; // n_rows() x n_free
    GapSize size_;
    Matrix left_out_; // B R_0, and M R_0; both empty where nothing is
    Field momenta_, place_;
};

} // namespace plm
