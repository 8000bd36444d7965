// Symmetric eigenproblems: dsyevd, dsyevr, dsygvd.
#include "blas_lapack.hpp"
#include "lapack.hpp"
#include <algorithm>
#include <limits>

namespace plm {
namespace {

void require_symmetric_input(const Matrix &a, const char *routine) {
    require(a.rows() == a.cols(), "symmetric eigenproblem: matrix not square");
    require_finite(a.data(), a.rows() * a.cols(), routine);
}

[[noreturn]] void not_converged(const char *routine, blas_int info) {
    throw Error(status::eigensolver, format("%s did not converge (info = %d)", routine, info))
        .library_code(info);
}

/// Workspace of dsyevd and dsygvd with vectors, by their documented formula.
struct DivideAndConquerWork {
    vector<double> work;
    vector<blas_int> iwork;
    blas_int lwork, liwork;
    explicit DivideAndConquerWork(std::int64_t n)
        : lwork(to_blas(1 + 6 * n + 2 * n * n)), liwork(to_blas(3 + 5 * n)) {
        work.resize(lwork);
        iwork.resize(liwork);
    }
};

/// Largest absolute row sum of the symmetric matrix in the lower triangle: it bounds every eigenvalue.
double lower_norm(const Matrix &a) {
    vector<double> sum(a.rows(), 0.0);
    for (std::int64_t j = 0; j < a.cols(); ++j)
        for (std::int64_t i = j; i < a.rows(); ++i) {
            sum[i] += std::fabs(a(i, j));
            if (i != j) sum[j] += std::fabs(a(i, j));
        }
    return *std::max_element(sum.begin(), sum.end());
}

SymmetricEigen keep_first(SymmetricEigen all, std::int64_t count) {
    all.values.resize(count);
    all.vectors = all.vectors.columns(0, count);
    return all;
}

SymmetricEigen all_below(const Matrix &a, double upper) {
    SymmetricEigen all = symmetric_eigen(a);
    const auto end = std::upper_bound(all.values.begin(), all.values.end(), upper);
    return keep_first(std::move(all), end - all.values.begin());
}

} // namespace

SymmetricEigen symmetric_eigen(const Matrix &a) {
    require_symmetric_input(a, "dsyevd");
    SymmetricEigen result{vector<double>(a.rows()), a};
    if (a.rows() == 0) return result;
    const blas_int n = to_blas(a.rows());
    DivideAndConquerWork w(n);
    blas_int info = 0;
    dsyevd_("V", "L", &n, result.vectors.data(), &n, result.values.data(), w.work.data(), &w.lwork,
            w.iwork.data(), &w.liwork, &info, 1, 1);
    require_valid(info, "dsyevd");
    if (info > 0) not_converged("dsyevd", info);
    return result;
}

SymmetricEigen symmetric_eigen_below(const Matrix &a, double upper) {
    require_symmetric_input(a, "dsyevr");
    require(!std::isnan(upper), "symmetric_eigen_below: bound is NaN");
    SymmetricEigen result;
    if (a.rows() == 0) return result;
    const blas_int n = to_blas(a.rows());
    const double norm = lower_norm(a);
    if (upper >= norm) return symmetric_eigen(a);
    // dsyevr wants a finite lower end strictly below the upper one (else XERBLA); the norm bounds every
    // eigenvalue.
    const double lower = -1.001 * norm - std::numeric_limits<double>::min();
    result.vectors.reset(n, 0);
    if (upper <= lower) return result;

    Matrix work_matrix = a, z(n, n);
    vector<double> values(n), work(26 * static_cast<std::size_t>(n));
    vector<blas_int> support(2 * static_cast<std::size_t>(n)), iwork(10 * static_cast<std::size_t>(n));
    const blas_int lwork = to_blas(26 * std::int64_t(n)), liwork = to_blas(10 * std::int64_t(n)), none = 0;
    const double tolerance = 0;
    blas_int found = 0, info = 0;
    dsyevr_("V", "V", "L", &n, work_matrix.data(), &n, &lower, &upper, &none, &none, &tolerance, &found,
            values.data(), z.data(), &n, support.data(), work.data(), &lwork, iwork.data(), &liwork, &info, 1,
            1, 1);
    require_valid(info, "dsyevr");
    if (info > 0) return all_below(a, upper); // bisection or inverse iteration failed: take the robust way
    result.values = std::move(values);
    result.vectors = std::move(z);
    return keep_first(std::move(result), found);
}

SymmetricEigen symmetric_eigen_general(const Matrix &a, const Matrix &b) {
    require_symmetric_input(a, "dsygvd");
    require_symmetric_input(b, "dsygvd");
    require(a.rows() == b.rows(), "dsygvd: shapes differ");
    SymmetricEigen result{vector<double>(a.rows()), a};
    if (a.rows() == 0) return result;
    Matrix factor = b;
    const blas_int n = to_blas(a.rows()), type = 1;
    DivideAndConquerWork w(n);
    blas_int info = 0;
    dsygvd_(&type, "V", "L", &n, result.vectors.data(), &n, factor.data(), &n, result.values.data(),
            w.work.data(), &w.lwork, w.iwork.data(), &w.liwork, &info, 1, 1);
    require_valid(info, "dsygvd");
    if (info > n)
        throw Error(status::not_positive_definite,
                    format("dsygvd: second matrix not positive definite at %d", info - n - 1))
            .reason(reason::not_positive_definite)
            .index(info - n - 1)
            .library_code(info);
    if (info > 0) not_converged("dsygvd", info);
    return result;
}

} // namespace plm
