// Dense column-major matrix that owns its storage: the only dense type of the library.
#pragma once
#include "memory.hpp"
#include <cstdint>

namespace plm {

class Matrix {
  public:
    Matrix() = default;
    Matrix(std::int64_t rows, std::int64_t cols) : rows_(rows), cols_(cols), data_(rows * cols, 0.0) {}
    std::int64_t rows() const { return rows_; }
    std::int64_t cols() const { return cols_; }
    bool empty() const { return data_.empty(); }
    double *data() { return data_.data(); }
    const double *data() const { return data_.data(); }
    /// Column j; j = cols() is the end of the last one.
    double *col(std::int64_t j) { return data_.data() + column_at(j); }
    const double *col(std::int64_t j) const { return data_.data() + column_at(j); }
    double &operator()(std::int64_t i, std::int64_t j) { return data_.data()[entry_at(i, j)]; }
    double operator()(std::int64_t i, std::int64_t j) const { return data_.data()[entry_at(i, j)]; }

    /// New shape, contents zeroed; storage is kept when it suffices.
    void reset(std::int64_t rows, std::int64_t cols);
    /// New shape, contents left to be overwritten.
    void reshape(std::int64_t rows, std::int64_t cols);
    /// Columns [first, first + count) as a copy.
    Matrix columns(std::int64_t first, std::int64_t count) const;
    /// Appends the columns of `other` (same number of rows; an empty matrix takes its shape).
    void append(const Matrix &other);
    /// Storage for so many columns in all: they are appended without a move, and what is not yet there has
    /// touched no memory.
    void reserve(std::int64_t rows, std::int64_t cols);
    /// The first so many columns stay.
    void cut(std::int64_t cols);
    Matrix transposed() const;

  private:
    [[noreturn]] void outside(std::int64_t i, std::int64_t j) const; // PLM_ERR_INTERNAL
#ifdef PLM_CHECKED // builds for development: no index leaves its array
    static constexpr bool checked = true;
#else
    static constexpr bool checked = false;
#endif
    std::int64_t column_at(std::int64_t j) const {
        if (checked && (j < 0 || j > cols_)) outside(0, j);
        return j * rows_;
    }
    std::int64_t entry_at(std::int64_t i, std::int64_t j) const {
        if (checked && (i < 0 || i >= rows_ || j < 0 || j >= cols_)) outside(i, j);
        return i + j * rows_;
    }

    std::int64_t rows_ = 0, cols_ = 0;
    vector<double> data_;
};

/// A(rows, :)
Matrix select_rows(const Matrix &a, const vector<std::int64_t> &rows);
void select_rows(const Matrix &a, const vector<std::int64_t> &rows, Matrix &out);
/// C = alpha op(A) op(B) + beta C; op is 'N' or 'T'. Shapes are checked (PLM_ERR_INTERNAL on mismatch).
void gemm(char op_a, char op_b, double alpha, const Matrix &a, const Matrix &b, double beta, Matrix &c);
/// C = alpha op(A) B + beta C with n columns of B and C that follow one another in larger arrays.
void gemm(char op, double alpha, const Matrix &a, const double *b, std::int64_t n, double beta, double *c);
/// C = alpha op(A) B + beta C on plain arrays, op(A) m x k, in double and in single precision.
void gemm(char op, std::int64_t m, std::int64_t n, std::int64_t k, double alpha, const double *a,
          std::int64_t lda, const double *b, std::int64_t ldb, double beta, double *c, std::int64_t ldc);
void gemm(char op, std::int64_t m, std::int64_t n, std::int64_t k, float alpha, const float *a,
          std::int64_t lda, const float *b, std::int64_t ldb, float beta, float *c, std::int64_t ldc);
/// op(A) op(B) as a new matrix.
Matrix product(char op_a, char op_b, const Matrix &a, const Matrix &b);
Matrix identity(std::int64_t n);
/// y = alpha op(A) x + beta y
void gemv(char op, double alpha, const Matrix &a, const double *x, double beta, double *y);
/// The same on plain arrays, A rows x cols, beta = 0: y is not read. In double and in single precision.
void gemv(char op, std::int64_t rows, std::int64_t cols, double alpha, const double *a, std::int64_t lda,
          const double *x, double beta, double *y);
void gemv(char op, std::int64_t rows, std::int64_t cols, float alpha, const float *a, std::int64_t lda,
          const float *x, float beta, float *y);
double dot(std::int64_t n, const double *x, const double *y);
double norm2(std::int64_t n, const double *x); // overflow-safe (dnrm2)
/// Entries between 0.5 and 1.5 without a pattern: a start or a right-hand side that no symmetry of a system
/// makes orthogonal to the vector looked for.
vector<double> patternless_vector(std::int64_t n);

} // namespace plm
