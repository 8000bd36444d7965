// Singular values and least squares: dgesdd, dgesvd, dgels.
#include "blas_lapack.hpp"
#include "lapack.hpp"
#include <algorithm>

namespace plm {
namespace {

/// LAPACK's answer to a workspace query.
blas_int work_size(double answer) {
    if (!(answer < INT_MAX))
        throw Error(status::argument, "matrix too large for the 32-bit workspace of LAPACK");
    return std::max(1, static_cast<blas_int>(answer));
}

blas_int svd_divide_and_conquer(Matrix &a, Svd &s) {
    const blas_int m = to_blas(a.rows()), n = to_blas(a.cols()), small = std::min(m, n), query = -1;
    vector<blas_int> iwork(8 * static_cast<std::size_t>(small));
    double size = 0;
    blas_int info = 0;
    dgesdd_("S", &m, &n, a.data(), &m, s.values.data(), s.u.data(), &m, s.vt.data(), &small, &size, &query,
            iwork.data(), &info, 1);
    require_valid(info, "dgesdd");
    const blas_int lwork = work_size(size);
    vector<double> work(lwork);
    dgesdd_("S", &m, &n, a.data(), &m, s.values.data(), s.u.data(), &m, s.vt.data(), &small, work.data(),
            &lwork, iwork.data(), &info, 1);
    require_valid(info, "dgesdd");
    return info;
}

blas_int svd_qr_iteration(Matrix &a, Svd &s) {
    const blas_int m = to_blas(a.rows()), n = to_blas(a.cols()), small = std::min(m, n), query = -1;
    double size = 0;
    blas_int info = 0;
    dgesvd_("S", "S", &m, &n, a.data(), &m, s.values.data(), s.u.data(), &m, s.vt.data(), &small, &size,
            &query, &info, 1, 1);
    require_valid(info, "dgesvd");
    const blas_int lwork = work_size(size);
    vector<double> work(lwork);
    dgesvd_("S", "S", &m, &n, a.data(), &m, s.values.data(), s.u.data(), &m, s.vt.data(), &small, work.data(),
            &lwork, &info, 1, 1);
    require_valid(info, "dgesvd");
    return info;
}

} // namespace

Svd thin_svd(const Matrix &a) {
    require_finite(a.data(), a.rows() * a.cols(), "dgesdd"); // dgesdd may loop for ever on NaN
    const std::int64_t small = std::min(a.rows(), a.cols());
    Svd s{vector<double>(small), Matrix(a.rows(), small), Matrix(small, a.cols())};
    if (small == 0) return s;
    Matrix scratch = a;
    blas_int info = svd_divide_and_conquer(scratch, s);
    if (info > 0) {
        scratch = a;
        info = svd_qr_iteration(scratch, s);
    }
    if (info > 0)
        throw Error(status::eigensolver, format("singular values did not converge (dgesvd, info = %d)", info))
            .library_code(info);
    return s;
}

Matrix least_squares(const Matrix &a, const Matrix &b) {
    require(a.rows() == b.rows() && a.rows() >= a.cols(), "least_squares: shapes");
    require_finite(a.data(), a.rows() * a.cols(), "dgels");
    require_finite(b.data(), b.rows() * b.cols(), "dgels");
    Matrix x(a.cols(), b.cols());
    if (x.empty()) return x;
    Matrix factor = a, rhs = b;
    const blas_int m = to_blas(a.rows()), n = to_blas(a.cols()), nrhs = to_blas(b.cols()), query = -1;
    double size = 0;
    blas_int info = 0;
    dgels_("N", &m, &n, &nrhs, factor.data(), &m, rhs.data(), &m, &size, &query, &info, 1);
    require_valid(info, "dgels");
    const blas_int lwork = work_size(size);
    vector<double> work(lwork);
    dgels_("N", &m, &n, &nrhs, factor.data(), &m, rhs.data(), &m, work.data(), &lwork, &info, 1);
    require_valid(info, "dgels");
    if (info > 0)
        throw Error(status::singular, format("least squares: column %d depends on the others", info - 1))
            .reason(reason::singular)
            .index(info - 1)
            .library_code(info);
    for (std::int64_t j = 0; j < x.cols(); ++j) std::copy_n(rhs.col(j), x.rows(), x.col(j));
    return x;
}

} // namespace plm
