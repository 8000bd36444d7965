// Eigenproblems of real matrices without symmetry: dgeev.
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
        throw Error(PLM_ERR_EIGENSOLVER, format("dgeev did not converge (info = %d)", info))
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

} // namespace plm
