// Sparse matrices: compressed columns, 64-bit indices, sorted rows, both triangles of a symmetric matrix
// stored.
#pragma once
#include "linalg/dense.hpp"

namespace plm {

struct SparseMatrix {
    std::int64_t rows = 0, cols = 0;
    vector<std::int64_t> ptr; // cols + 1
    vector<std::int64_t> idx; // row of each entry, ascending within a column, unique
    vector<double> val;
    std::int64_t nnz() const { return static_cast<std::int64_t>(idx.size()); }
};

/// From triplets (base 0); duplicates are summed.
SparseMatrix from_triplets(std::int64_t rows, std::int64_t cols, const vector<std::int64_t> &i,
                           const vector<std::int64_t> &j, const vector<double> &v);
SparseMatrix transpose(const SparseMatrix &a);
/// alpha A + beta B (same shape; union of the patterns).
SparseMatrix add(double alpha, const SparseMatrix &a, double beta, const SparseMatrix &b);
/// A(rows, cols) where keep_row[i] / keep_col[j] is the new index or -1 to drop.
SparseMatrix submatrix(const SparseMatrix &a, const vector<std::int64_t> &keep_row, std::int64_t n_rows,
                       const vector<std::int64_t> &keep_col, std::int64_t n_cols);
/// Square A without the zeros off its diagonal that it stores, where they are a good part of its entries. A
/// dense one stays.
SparseMatrix without_zeros(SparseMatrix a);
/// y = A x (x: cols, y: rows) and y = A^T x, which gathers and so is the faster one where A is symmetric.
void multiply(const SparseMatrix &a, const double *x, double *y);
void multiply_transposed(const SparseMatrix &a, const double *x, double *y);
/// A X for a block of columns; one pass over A for several columns at a time.
Matrix multiply(const SparseMatrix &a, const Matrix &x);
Matrix multiply_transposed(const SparseMatrix &a, const Matrix &x);

/// x' A x of a symmetric A, summed in twice the digits: the large terms of penalties cancel, and what is left
/// has all its digits. terms: |x|' |A| |x|, of which rounding of A and of x leaves a share.
struct Energy {
    double sum = 0, terms = 0;
};
Energy energy(const SparseMatrix &a, const double *x);
Matrix to_dense(const SparseMatrix &a);
/// Every entry is stored, and there are so many of them that BLAS and LAPACK are the faster ones: the values
/// are a dense matrix, column-major.
bool is_dense(const SparseMatrix &a);
double norm_inf(const SparseMatrix &a); // largest absolute row sum
vector<double> diagonal(const SparseMatrix &a);
double trace(const SparseMatrix &a);

} // namespace plm
