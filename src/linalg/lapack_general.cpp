// Eigenproblems of real matrices without symmetry: dgeev, and Schur's form where eigenvectors coincide.
#include "blas_lapack.hpp"
#include "lapack.hpp"
#include "work.hpp"
#include <algorithm>
#include <numeric>

namespace plm {
namespace {

/// dgeev's result as it stands: values split in two, a complex pair of vectors in two real columns.
struct RawEigen {
    vector<double> real, imag;
    Matrix vectors; // n x n or empty
};

RawEigen run_dgeev(Matrix a, bool with_vectors) {
    require(a.rows() == a.cols(), "dgeev: matrix not square");
    require_finite(a.data(), a.rows() * a.cols(), "dgeev");
    RawEigen e{vector<double>(a.rows()), vector<double>(a.rows()), Matrix()};
    if (a.rows() == 0) return e;
    if (with_vectors) e.vectors.reset(a.rows(), a.rows());
    const blas_int n = to_blas(a.rows()), one = 1, ask = -1;
    const char *job = with_vectors ? "V" : "N";
    double *vectors = with_vectors ? e.vectors.data() : nullptr, best = 0;
    const blas_int ldv = with_vectors ? n : 1;
    blas_int info = 0;
    dgeev_("N", job, &n, a.data(), &n, e.real.data(), e.imag.data(), nullptr, &one, vectors, &ldv, &best,
           &ask, &info, 1, 1);
    require_valid(info, "dgeev");
    const blas_int lwork = std::max(to_blas(static_cast<std::int64_t>(best)), to_blas(4 * a.rows()));
    vector<double> work(lwork);
    worked((with_vectors ? 25.0 : 10.0) * n * n * n);
    dgeev_("N", job, &n, a.data(), &n, e.real.data(), e.imag.data(), nullptr, &one, vectors, &ldv,
           work.data(), &lwork, &info, 1, 1);
    require_valid(info, "dgeev");
    if (info > 0)
        throw Error(status::eigensolver, format("dgeev did not converge (info = %d)", info))
            .library_code(info);
    return e;
}

// Largest modulus first. Conjugates have the same modulus to the last bit, and the sort is stable.
vector<std::int64_t> order_of(const RawEigen &e) {
    vector<std::int64_t> order(e.real.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::int64_t i, std::int64_t j) {
        return std::hypot(e.real[i], e.imag[i]) > std::hypot(e.real[j], e.imag[j]);
    });
    return order;
}

// dgeev keeps the vector of a pair as its real part in the first column and its imaginary part in the next.
void copy_vector(const RawEigen &e, std::int64_t j, complex_t *out) {
    const std::int64_t n = e.vectors.rows();
    const std::int64_t first = e.imag[j] < 0 ? j - 1 : j;
    for (std::int64_t i = 0; i < n; ++i) {
        const double imag = e.imag[j] == 0 ? 0.0 : e.vectors(i, first + 1);
        out[i] = {e.vectors(i, first), e.imag[j] < 0 ? -imag : imag};
    }
}

} // namespace

vector<complex_t> general_eigenvalues(const Matrix &a) {
    const RawEigen e = run_dgeev(a, false);
    vector<complex_t> values;
    for (std::int64_t j : order_of(e)) values.emplace_back(e.real[j], e.imag[j]);
    return values;
}

GeneralEigen general_eigen(const Matrix &a) {
    const RawEigen e = run_dgeev(a, true);
    GeneralEigen result;
    result.vectors.resize(static_cast<std::size_t>(a.rows() * a.rows()));
    std::int64_t column = 0;
    for (std::int64_t j : order_of(e)) {
        result.values.emplace_back(e.real[j], e.imag[j]);
        copy_vector(e, j, result.vectors.data() + a.rows() * column++);
    }
    return result;
}

namespace {

void require_converged(blas_int info, const char *routine) {
    require_valid(info, routine);
    if (info > 0)
        throw Error(status::eigensolver, format("%s did not converge (info = %d)", routine, info))
            .library_code(info);
}

// A = Z T Z^T with the eigenvalues of modulus below `radius` first; their number.
blas_int order_schur(Matrix &t, Matrix &z, double radius) {
    const blas_int n = to_blas(t.rows()), lwork = std::max<blas_int>(3 * n, 1),
                   liwork = std::max<blas_int>(n, 1);
    vector<double> real(static_cast<std::size_t>(n)), imag(real), work(static_cast<std::size_t>(lwork));
    vector<int> chosen(static_cast<std::size_t>(n)), iwork(static_cast<std::size_t>(liwork));
    blas_int info = 0, none = 0, count = 0;
    worked(25.0 * n * n * n);
    dgees_("V", "N", nullptr, &n, t.data(), &n, &none, real.data(), imag.data(), z.data(), &n, work.data(),
           &lwork, nullptr, &info, 1, 1);
    require_converged(info, "dgees");
    for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = std::hypot(real[i], imag[i]) < radius;
    double condition = 0, separation = 0;
    dtrsen_("N", "V", chosen.data(), &n, t.data(), &n, z.data(), &n, real.data(), imag.data(), &count,
            &condition, &separation, work.data(), &lwork, iwork.data(), &liwork, &info, 1, 1);
    require_converged(info, "dtrsen");
    return count;
}

Matrix block(const Matrix &a, std::int64_t row, std::int64_t column, std::int64_t rows,
             std::int64_t columns) {
    Matrix b(rows, columns);
    for (std::int64_t j = 0; j < columns; ++j) std::copy_n(a.col(column + j) + row, rows, b.col(j));
    return b;
}

} // namespace

// (Z1, Z1 X + Z2) with T11 X - X T22 = -T12 takes the coupling away that Schur's form leaves.
SplitSpectrum split_spectrum(const Matrix &a, double radius) {
    require(a.rows() == a.cols(), "dgees: matrix not square");
    require_finite(a.data(), a.rows() * a.cols(), "dgees");
    Matrix t = a, z(a.rows(), a.rows());
    const blas_int k = order_schur(t, z, radius), n = to_blas(a.rows()), m = n - k, minus = -1;
    SplitSpectrum s{block(z, 0, 0, n, k), block(t, 0, 0, k, k), block(z, 0, k, n, m), block(t, k, k, m, m)};
    if (k == 0 || m == 0) return s;
    Matrix x = block(t, 0, k, k, m);
    for (std::int64_t i = 0; i < x.rows() * x.cols(); ++i) x.data()[i] = -x.data()[i];
    double scale = 1;
    blas_int info = 0;
    dtrsyl_("N", "N", &minus, &k, &m, s.slow_block.data(), &k, s.rest_block.data(), &m, x.data(), &k, &scale,
            &info, 1, 1);
    require_valid(info, "dtrsyl");
    gemm('N', 'N', 1.0 / scale, s.slow, x, 1.0, s.rest);
    return s;
}

} // namespace plm
