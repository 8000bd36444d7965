// Private to linalg: Fortran prototypes of the BLAS and LAPACK routines used (32-bit integers) and the checks
// that keep XERBLA, which prints and stops the process, out of reach. Each character argument has its length
// passed behind the list, as gfortran expects it.
#pragma once
#include "blas_turn.hpp"
#include "error.hpp"
#include <climits>
#include <cmath>
#include <complex>

namespace plm {

using blas_int = int;
using strlen_t = std::size_t;
using complex_t = std::complex<double>;

extern "C" {
void dgemm_(const char *, const char *, const blas_int *, const blas_int *, const blas_int *, const double *,
            const double *, const blas_int *, const double *, const blas_int *, const double *, double *,
            const blas_int *, strlen_t, strlen_t);
void dgemv_(const char *, const blas_int *, const blas_int *, const double *, const double *,
            const blas_int *, const double *, const blas_int *, const double *, double *, const blas_int *,
            strlen_t);
void sgemv_(const char *, const blas_int *, const blas_int *, const float *, const float *, const blas_int *,
            const float *, const blas_int *, const float *, float *, const blas_int *, strlen_t);
double ddot_(const blas_int *, const double *, const blas_int *, const double *, const blas_int *);
double dnrm2_(const blas_int *, const double *, const blas_int *);
void dtrsm_(const char *, const char *, const char *, const char *, const blas_int *, const blas_int *,
            const double *, const double *, const blas_int *, double *, const blas_int *, strlen_t, strlen_t,
            strlen_t, strlen_t);
void dtrsv_(const char *, const char *, const char *, const blas_int *, const double *, const blas_int *,
            double *, const blas_int *, strlen_t, strlen_t, strlen_t);
void strsv_(const char *, const char *, const char *, const blas_int *, const float *, const blas_int *,
            float *, const blas_int *, strlen_t, strlen_t, strlen_t);
void sgemm_(const char *, const char *, const blas_int *, const blas_int *, const blas_int *, const float *,
            const float *, const blas_int *, const float *, const blas_int *, const float *, float *,
            const blas_int *, strlen_t, strlen_t);
void strsm_(const char *, const char *, const char *, const char *, const blas_int *, const blas_int *,
            const float *, const float *, const blas_int *, float *, const blas_int *, strlen_t, strlen_t,
            strlen_t, strlen_t);

void dsyevd_(const char *, const char *, const blas_int *, double *, const blas_int *, double *, double *,
             const blas_int *, blas_int *, const blas_int *, blas_int *, strlen_t, strlen_t);
void dsyevr_(const char *, const char *, const char *, const blas_int *, double *, const blas_int *,
             const double *, const double *, const blas_int *, const blas_int *, const double *, blas_int *,
             double *, double *, const blas_int *, blas_int *, double *, const blas_int *, blas_int *,
             const blas_int *, blas_int *, strlen_t, strlen_t, strlen_t);
void dsygvd_(const blas_int *, const char *, const char *, const blas_int *, double *, const blas_int *,
             double *, const blas_int *, double *, double *, const blas_int *, blas_int *, const blas_int *,
             blas_int *, strlen_t, strlen_t);
void dgesdd_(const char *, const blas_int *, const blas_int *, double *, const blas_int *, double *, double *,
             const blas_int *, double *, const blas_int *, double *, const blas_int *, blas_int *, blas_int *,
             strlen_t);
void dgesvd_(const char *, const char *, const blas_int *, const blas_int *, double *, const blas_int *,
             double *, double *, const blas_int *, double *, const blas_int *, double *, const blas_int *,
             blas_int *, strlen_t, strlen_t);
void dgels_(const char *, const blas_int *, const blas_int *, const blas_int *, double *, const blas_int *,
            double *, const blas_int *, double *, const blas_int *, blas_int *, strlen_t);
void dlaswp_(const blas_int *, double *, const blas_int *, const blas_int *, const blas_int *,
             const blas_int *, const blas_int *);
void dgetrf_(const blas_int *, const blas_int *, double *, const blas_int *, blas_int *, blas_int *);
void dgetrs_(const char *, const blas_int *, const blas_int *, const double *, const blas_int *,
             const blas_int *, double *, const blas_int *, blas_int *, strlen_t);
void dgecon_(const char *, const blas_int *, const double *, const blas_int *, const double *, double *,
             double *, blas_int *, blas_int *, strlen_t);
void zgetrf_(const blas_int *, const blas_int *, complex_t *, const blas_int *, blas_int *, blas_int *);
void zgetrs_(const char *, const blas_int *, const blas_int *, const complex_t *, const blas_int *,
             const blas_int *, complex_t *, const blas_int *, blas_int *, strlen_t);
void dgeev_(const char *, const char *, const blas_int *, double *, const blas_int *, double *, double *,
            double *, const blas_int *, double *, const blas_int *, double *, const blas_int *, blas_int *,
            strlen_t, strlen_t);
void dgees_(const char *, const char *, const void *, const blas_int *, double *, const blas_int *,
            blas_int *, double *, double *, double *, const blas_int *, double *, const blas_int *,
            blas_int *, blas_int *, strlen_t, strlen_t);
void dtrsen_(const char *, const char *, const blas_int *, const blas_int *, double *, const blas_int *,
             double *, const blas_int *, double *, double *, blas_int *, double *, double *, double *,
             const blas_int *, blas_int *, const blas_int *, blas_int *, strlen_t, strlen_t);
void dtrsyl_(const char *, const char *, const blas_int *, const blas_int *, const blas_int *, const double *,
             const blas_int *, const double *, const blas_int *, double *, const blas_int *, double *,
             blas_int *, strlen_t, strlen_t);
void dpotrf_(const char *, const blas_int *, double *, const blas_int *, blas_int *, strlen_t);
void dpotrs_(const char *, const blas_int *, const blas_int *, const double *, const blas_int *, double *,
             const blas_int *, blas_int *, strlen_t);
}

// Each call is a turn of its thread (BlasTurn lives to the end of the expression); what takes no work buffer
// needs none. A macro, so that no caller can forget it.
#define dgemm_(...) (BlasTurn(), dgemm_(__VA_ARGS__))
#define dgemv_(...) (BlasTurn(), dgemv_(__VA_ARGS__))
#define sgemv_(...) (BlasTurn(), sgemv_(__VA_ARGS__))
#define dtrsv_(...) (BlasTurn(), dtrsv_(__VA_ARGS__))
#define strsv_(...) (BlasTurn(), strsv_(__VA_ARGS__))
#define dtrsm_(...) (BlasTurn(), dtrsm_(__VA_ARGS__))
#define sgemm_(...) (BlasTurn(), sgemm_(__VA_ARGS__))
#define strsm_(...) (BlasTurn(), strsm_(__VA_ARGS__))
#define dsyevd_(...) (BlasTurn(), dsyevd_(__VA_ARGS__))
#define dsyevr_(...) (BlasTurn(), dsyevr_(__VA_ARGS__))
#define dsygvd_(...) (BlasTurn(), dsygvd_(__VA_ARGS__))
#define dgesdd_(...) (BlasTurn(), dgesdd_(__VA_ARGS__))
#define dgesvd_(...) (BlasTurn(), dgesvd_(__VA_ARGS__))
#define dgels_(...) (BlasTurn(), dgels_(__VA_ARGS__))
#define dlaswp_(...) (BlasTurn(), dlaswp_(__VA_ARGS__))
#define dgetrf_(...) (BlasTurn(), dgetrf_(__VA_ARGS__))
#define dgetrs_(...) (BlasTurn(), dgetrs_(__VA_ARGS__))
#define dgecon_(...) (BlasTurn(), dgecon_(__VA_ARGS__))
#define zgetrf_(...) (BlasTurn(), zgetrf_(__VA_ARGS__))
#define zgetrs_(...) (BlasTurn(), zgetrs_(__VA_ARGS__))
#define dgeev_(...) (BlasTurn(), dgeev_(__VA_ARGS__))
#define dgees_(...) (BlasTurn(), dgees_(__VA_ARGS__))
#define dtrsen_(...) (BlasTurn(), dtrsen_(__VA_ARGS__))
#define dtrsyl_(...) (BlasTurn(), dtrsyl_(__VA_ARGS__))
#define dpotrf_(...) (BlasTurn(), dpotrf_(__VA_ARGS__))
#define dpotrs_(...) (BlasTurn(), dpotrs_(__VA_ARGS__))

/// A dimension as BLAS takes it.
inline blas_int to_blas(std::int64_t n) {
    if (n < 0 || n > INT_MAX)
        throw Error(status::argument,
                    format("dimension %lld does not fit the 32-bit integers of BLAS and LAPACK",
                           static_cast<long long>(n)));
    return static_cast<blas_int>(n);
}
/// A leading dimension: BLAS wants at least 1 even for empty matrices.
inline blas_int leading(std::int64_t n) {
    return to_blas(n > 0 ? n : 1);
}

/// Defects of libplm's own calls.
inline void require(bool condition, const char *what) {
    if (!condition) throw Error(status::internal, what);
}
/// A negative info of LAPACK is a wrong argument, which is a defect of ours.
inline void require_valid(blas_int info, const char *routine) {
    if (info < 0) throw Error(status::internal, format("%s: argument %d", routine, -info)).library_code(info);
}

inline bool finite(const double *x, std::int64_t n) {
    // x - x is 0 for finite x and NaN otherwise: a sum of it needs no branch per element and vectorises.
    double sum = 0;
    for (std::int64_t i = 0; i < n; ++i) sum += x[i] - x[i];
    return sum == 0;
}
inline void require_finite(const double *x, std::int64_t n, const char *routine) {
    if (!finite(x, n)) throw Error(status::matrix, format("%s: NaN or Inf in the matrix", routine));
}

} // namespace plm
