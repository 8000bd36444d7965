// LAPACK as the core needs it: symmetric eigenproblems, SVD, QR, LU and Cholesky with readable errors.
// Every routine checks its input for NaN/Inf where LAPACK would hang or trap, and throws plm::Error.
#pragma once
#include "dense.hpp"
#include <complex>

namespace plm {

struct SymmetricEigen {
    vector<double> values; // ascending
    Matrix vectors;        // columns, orthonormal
};
/// All eigenpairs of a symmetric matrix (dsyevd; only the lower triangle is read).
SymmetricEigen symmetric_eigen(const Matrix &a);
/// Eigenpairs with value in (-inf, upper]; cheaper when few are wanted (dsyevr by value range).
SymmetricEigen symmetric_eigen_below(const Matrix &a, double upper);
/// A x = lambda B x, B positive definite; vectors B-orthonormal (dsygvd).
SymmetricEigen symmetric_eigen_general(const Matrix &a, const Matrix &b);

struct GeneralEigen {
    vector<std::complex<double>> values;  // conjugate pairs stand together, positive imaginary part first
    vector<std::complex<double>> vectors; // n x n column-major, Euclidean norm 1
};
/// Eigenvalues of a real square matrix that need not be symmetric (dgeev), largest modulus first.
vector<std::complex<double>> general_eigenvalues(const Matrix &a);
/// The same with right eigenvectors, column j belonging to value j.
GeneralEigen general_eigen(const Matrix &a);

/// A (slow rest) = (slow rest) diag(slow_block, rest_block): the eigenvalues of modulus below `radius` and
/// the others, each in an invariant subspace of its own, where eigenvectors of the former may coincide
/// (dgees, dtrsen, dtrsyl). The columns of slow are orthonormal.
struct SplitSpectrum {
    Matrix slow, slow_block, rest, rest_block;
};
SplitSpectrum split_spectrum(const Matrix &a, double radius);

struct Svd {
    vector<double> values; // descending
    Matrix u, vt;          // thin factors
};
Svd thin_svd(const Matrix &a); // dgesdd, falls back to dgesvd when it does not converge

/// Least squares min |A x - b| by QR (dgels); A has full column rank. b is rows x nrhs; returns cols x nrhs.
Matrix least_squares(const Matrix &a, const Matrix &b);

/// LU with partial pivoting of a real square matrix; the storage is reused between calls of factor().
class RealLu {
  public:
    /// Takes the matrix by swap (contents are destroyed). Exactly singular: the pivot is replaced by
    /// eps * max|a| and singular() says so, since a continuation may pass through a fold.
    void factor(Matrix &a);
    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const;
    void solve_transposed(double *x, std::int64_t nrhs, std::int64_t ldx) const; // A^T x = b
    bool singular() const { return singular_; }
    double reciprocal_condition() const; // 1-norm estimate, dgecon
    /// Sign of the determinant: +1 or -1 (branch and fold detection).
    int determinant_sign() const;
    std::int64_t size() const { return lu_.rows(); }

  private:
    void solve(char op, double *x, std::int64_t nrhs, std::int64_t ldx) const;
    Matrix lu_;
    vector<int> pivots_;
    double norm1_ = 0;
    bool singular_ = false;
};

/// LU of a complex square matrix, column-major (zgetrf/zgetrs); throws PLM_ERR_SINGULAR when singular.
class ComplexLu {
  public:
    void factor(std::int64_t n, vector<std::complex<double>> &a); // by swap
    void solve(std::complex<double> *x, std::int64_t nrhs, std::int64_t ldx) const;

  private:
    std::int64_t n_ = 0;
    vector<std::complex<double>> lu_;
    vector<int> pivots_;
};

/// Cholesky of a small dense symmetric positive definite matrix (dpotrf). Returns false if not positive
/// definite; then nothing may be solved.
class DenseCholesky {
  public:
    bool factor(Matrix &a); // by swap; lower triangle read
    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const;
    /// Column of the first pivot that is not positive, or -1.
    std::int64_t broke_at() const { return broke_at_; }
    const Matrix &lower() const { return l_; }

  private:
    Matrix l_;
    std::int64_t broke_at_ = -1;
};

} // namespace plm
