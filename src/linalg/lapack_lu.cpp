// Dense factorizations: dgetrf, zgetrf, dpotrf.
#include "blas_lapack.hpp"
#include "lanes.hpp"
#include "lapack.hpp"
#include "work.hpp"
#include <algorithm>
#include <limits>

namespace plm {

namespace {

// Between these orders narrow panels take 15 % less than dgetrf at once, which solves triangles where they
// multiply (OpenBLAS's kernels for 512 bit; 3 % with those for 256).
constexpr std::int64_t smallest = 48, small = 128, narrow = 8;

// Matrices of some size at once, large ones by panels of columns, so that the host hears of it between them.
// False: singular.
bool factor_panels(Matrix &lu, vector<int> &pivots) {
    const std::int64_t size = lu.rows();
    const double n_real = static_cast<double>(size), all = 2.0 / 3 * n_real * n_real * n_real;
    const std::int64_t width = size >= smallest && size <= small ? narrow
                               : all < piece_of_work             ? size
                                                                 : 128,
                       strip = std::max<std::int64_t>(
                           1, static_cast<std::int64_t>(piece_of_work / (256.0 * std::max(1.0, n_real))));
    const blas_int lda = leading(size), one = 1;
    const double plus = 1, minus = -1;
    bool regular = true;
    for (std::int64_t j = 0; j < size; j += width) {
        const std::int64_t below = std::min(size, j + width);
        const blas_int rows = to_blas(size - j), columns = to_blas(below - j), first = to_blas(j + 1),
                       last = to_blas(below), left = to_blas(j);
        double *const panel = lu.col(j) + j;
        blas_int info = 0;
        dgetrf_(&rows, &columns, panel, &lda, pivots.data() + j, &info);
        require_valid(info, "dgetrf");
        regular = regular && info == 0;
        for (std::int64_t k = j; k < below; ++k) pivots[k] += left;
        if (j > 0) dlaswp_(&left, lu.data(), &lda, &first, &last, pivots.data(), &one);
        for (std::int64_t k = below; k < size; k += strip) {
            const blas_int n = to_blas(std::min(strip, size - k)), m = to_blas(size - below);
            double *const upper = lu.col(k) + j;
            dlaswp_(&n, lu.col(k), &lda, &first, &last, pivots.data(), &one);
            dtrsm_("L", "L", "N", "U", &columns, &n, &plus, panel, &lda, upper, &lda, 1, 1, 1, 1);
            if (m > 0)
                dgemm_("N", "N", &m, &n, &columns, &minus, panel + (below - j), &lda, upper, &lda, &plus,
                       upper + (below - j), &lda, 1, 1);
            worked(in_products * 2.0 * m * n * columns);
        }
        worked(in_products * rows * columns * columns);
    }
    return regular;
}

struct ColumnSize {
    double sum, largest; // of the absolute values
};

template <class L> PLM_IN_LANES ColumnSize size_in_lanes(const double *c, std::int64_t n) {
    L sums{}, most{};
    std::int64_t i = 0;
    for (; i + n_lanes <= n; i += n_lanes) {
        const L value = absolute(L::load(c + i));
        sums += value;
        most = larger(most, value);
    }
    double sum[n_lanes], largest[n_lanes];
    sums.store(sum);
    most.store(largest);
    for (std::int64_t l = 1; l < n_lanes; ++l) {
        sum[0] += sum[l];
        largest[0] = std::max(largest[0], largest[l]);
    }
    for (; i < n; ++i) {
        sum[0] += std::fabs(c[i]);
        largest[0] = std::max(largest[0], std::fabs(c[i]));
    }
    return {sum[0], largest[0]};
}
PLM_WIDE_LANES ColumnSize size_in_wide_lanes(const double *c, std::int64_t n) {
    return size_in_lanes<Lanes<4>>(c, n);
}

// One sum alone would wait for each addition, as long as a small matrix takes to factor.
ColumnSize column_size(const double *c, std::int64_t n) {
    return has_wide_lanes() ? size_in_wide_lanes(c, n) : size_in_lanes<Lanes<2>>(c, n);
}

} // namespace

void RealLu::factor(Matrix &a) {
    require(a.rows() == a.cols(), "RealLu: matrix not square");
    const std::int64_t size = a.rows();
    double norm1 = 0, largest = 0;
    bool ok = true;
    for (std::int64_t j = 0; j < size; ++j) {
        const ColumnSize c = column_size(a.col(j), size);
        ok = ok && std::isfinite(c.sum); // a sum that overflows is no matrix to solve with either
        norm1 = std::max(norm1, c.sum);
        largest = std::max(largest, c.largest);
    }
    if (!ok) throw Error(status::matrix, "dgetrf: NaN or Inf in the matrix");

    std::swap(lu_, a);
    pivots_.resize(size);
    norm1_ = norm1;
    singular_ = !factor_panels(lu_, pivots_);
    if (!singular_) return;
    const double tiny = std::numeric_limits<double>::epsilon() * (largest > 0 ? largest : 1);
    for (std::int64_t i = 0; i < size; ++i)
        if (lu_(i, i) == 0) lu_(i, i) = tiny;
}

void RealLu::solve(double *x, std::int64_t nrhs, std::int64_t ldx) const {
    solve('N', x, nrhs, ldx);
}

void RealLu::solve_transposed(double *x, std::int64_t nrhs, std::int64_t ldx) const {
    solve('T', x, nrhs, ldx);
}

void RealLu::solve(char op, double *x, std::int64_t nrhs, std::int64_t ldx) const {
    const blas_int n = to_blas(size()), lda = leading(size()), m = to_blas(nrhs), ldb = to_blas(ldx);
    if (n == 0 || m == 0) return;
    require(ldx >= size(), "RealLu: leading dimension");
    blas_int info = 0;
    dgetrs_(&op, &n, &m, lu_.data(), &lda, pivots_.data(), x, &ldb, &info, 1);
    require_valid(info, "dgetrs");
    worked(2.0 * n * n * m);
}

double RealLu::reciprocal_condition() const {
    if (singular_) return 0;
    const blas_int n = to_blas(size());
    if (n == 0) return 1;
    vector<double> work(4 * static_cast<std::size_t>(n));
    vector<blas_int> iwork(n);
    double rcond = 0;
    blas_int info = 0;
    dgecon_("1", &n, lu_.data(), &n, &norm1_, &rcond, work.data(), iwork.data(), &info, 1);
    require_valid(info, "dgecon");
    return rcond;
}

int RealLu::determinant_sign() const {
    bool negative = false;
    for (std::int64_t i = 0; i < size(); ++i) negative ^= (pivots_[i] != i + 1) != (lu_(i, i) < 0);
    return negative ? -1 : 1;
}

void ComplexLu::factor(std::int64_t n, vector<complex_t> &a) {
    require(n >= 0 && static_cast<std::int64_t>(a.size()) == n * n, "ComplexLu: size of the array");
    const blas_int size = to_blas(n), lda = leading(n);
    require_finite(reinterpret_cast<const double *>(a.data()), 2 * n * n, "zgetrf");
    n_ = n;
    std::swap(lu_, a);
    pivots_.resize(n);
    blas_int info = 0;
    zgetrf_(&size, &size, lu_.data(), &lda, pivots_.data(), &info);
    require_valid(info, "zgetrf");
    worked(in_products * 8 / 3 * static_cast<double>(n) * static_cast<double>(n) * static_cast<double>(n));
    if (info == 0) return;
    n_ = 0; // nothing may be solved
    throw Error(status::singular, format("zgetrf: matrix singular at %d", info - 1))
        .reason(reason::singular)
        .index(info - 1)
        .library_code(info);
}

void ComplexLu::solve(complex_t *x, std::int64_t nrhs, std::int64_t ldx) const {
    const blas_int n = to_blas(n_), m = to_blas(nrhs), ldb = to_blas(ldx);
    if (n == 0 || m == 0) return;
    require(ldx >= n_, "ComplexLu: leading dimension");
    blas_int info = 0;
    zgetrs_("N", &n, &m, lu_.data(), &n, pivots_.data(), x, &ldb, &info, 1);
    require_valid(info, "zgetrs");
}

bool DenseCholesky::factor(Matrix &a) {
    require(a.rows() == a.cols(), "DenseCholesky: matrix not square");
    require_finite(a.data(), a.rows() * a.cols(), "dpotrf");
    const blas_int n = to_blas(a.rows()), lda = leading(a.rows());
    std::swap(l_, a);
    blas_int info = 0;
    dpotrf_("L", &n, l_.data(), &lda, &info, 1);
    require_valid(info, "dpotrf");
    worked(1e4 + static_cast<double>(n) * n * n / 3);
    broke_at_ = info - 1;
    if (info > 0) l_.reset(0, 0);
    return info == 0;
}

void DenseCholesky::solve(double *x, std::int64_t nrhs, std::int64_t ldx) const {
    const blas_int n = to_blas(l_.rows()), m = to_blas(nrhs), ldb = to_blas(ldx);
    if (n == 0 || m == 0) return;
    require(ldx >= l_.rows(), "DenseCholesky: leading dimension");
    blas_int info = 0;
    dpotrs_("L", &n, &m, l_.data(), &n, x, &ldb, &info, 1);
    require_valid(info, "dpotrs");
}

} // namespace plm
