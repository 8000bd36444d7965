// What eigenpairs miss their equation by, and the iteration by which they come to meet it.
#include "linalg/blas_lapack.hpp"
#include "linalg/lapack.hpp"
#include "structure/eigs_internal.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace plm {

// By the Cholesky factor of their Gram matrix (close to the identity, so that one pass suffices).
Matrix orthonormalize(const SparseMatrix &m, Matrix &x) {
    Matrix mx = multiply_transposed(m, x);
    Matrix gram = product('T', 'N', x, mx);
    const blas_int n = to_blas(x.rows()), count = to_blas(x.cols());
    if (n == 0 || count == 0) return mx;
    require_finite(gram.data(), gram.rows() * gram.cols(), "eigensolver, Gram matrix");
    blas_int info = 0;
    dpotrf_("L", &count, gram.data(), &count, &info, 1);
    if (info != 0)
        throw Error(status::eigensolver, "the eigenvectors found are linearly dependent").library_code(info);
    const double one = 1;
    for (Matrix *block : {&x, &mx})
        dtrsm_("R", "L", "T", "N", &n, &count, &one, gram.data(), &count, block->data(), &n, 1, 1, 1, 1);
    return mx;
}

namespace {

/// K X and |K| |X|: the size of the terms of each row, of which rounding is a share.
struct Products {
    Matrix kx, terms;
    Products(const SparseMatrix &k, const Matrix &x) : kx(multiply_transposed(k, x)) {
        SparseMatrix sizes = k;
        for (double &a : sizes.val) a = std::fabs(a);
        Matrix motion = x;
        for (std::int64_t i = 0; i < x.rows() * x.cols(); ++i) motion.data()[i] = std::fabs(x.data()[i]);
        terms = multiply_transposed(sizes, motion);
    }
};

/// The share of K X - M X diag(lambda) in the size of its terms that rounding of K X, which counts in its own
/// row only, does not explain: with penalties rounding of theirs exceeds lambda M x.
vector<double> relative_residuals(const Pencil &pencil, const EigenPairs &pairs, const Products &p,
                                  const Matrix &mx) {
    constexpr double rounding = 1e-12;
    const std::int64_t n = pencil.size();
    vector<double> beyond(n), relative;
    for (std::int64_t j = 0; j < mx.cols(); ++j) {
        const double lambda = pairs.values[j];
        for (std::int64_t i = 0; i < n; ++i)
            beyond[i] = std::max(0.0, std::fabs(p.kx(i, j) - lambda * mx(i, j)) - rounding * p.terms(i, j));
        const double inertia = (std::fabs(lambda) + std::fabs(lambda - pencil.shift)) * norm2(n, mx.col(j));
        relative.push_back(finite(p.kx.col(j), n) ? norm2(n, beyond.data()) / inertia : INFINITY);
    }
    return relative;
}

/// |x|' |K| |x|, of which rounding leaves eps in x' K x.
double absolute_energy(const EigenPairs &pairs, const Products &p, std::int64_t j) {
    double energy = 0;
    for (std::int64_t i = 0; i < p.terms.rows(); ++i)
        energy += std::fabs(pairs.vectors(i, j)) * p.terms(i, j);
    return energy;
}

/// Beside a far smaller eigenvalue theta = 1 / (lambda - shift) leaves a value few digits: then its Rayleigh
/// quotient has more. Beside penalties rounding of the factor and of K x leaves few to both: then it is
/// summed with more.
void take_better_values(const Pencil &pencil, EigenPairs &pairs, const Products &p) {
    constexpr double eps = std::numeric_limits<double>::epsilon(), certain = 1e-9;
    const double first = std::fabs(pairs.values[0] - pencil.shift);
    for (std::int64_t j = 0; j < p.kx.cols(); ++j) {
        const double apart = std::fabs(pairs.values[j] - pencil.shift);
        const double terms = absolute_energy(pairs, p, j);
        if (eps * terms > certain * std::fabs(pairs.values[j]))
            pairs.values[j] = energy(pencil.k, pairs.vectors.col(j)).sum;
        else if (apart * (apart / first) > terms)
            pairs.values[j] = dot(pencil.size(), pairs.vectors.col(j), p.kx.col(j));
    }
}

/// No pair is more certain than rounding of K leaves its value above the shift.
vector<std::int64_t> larger_than_allowed(const Pencil &pencil, const EigenPairs &pairs, const Products &p,
                                         const vector<double> &relative) {
    constexpr double eps = std::numeric_limits<double>::epsilon();
    const double allowed = std::max(1e-6, 100 * pencil.options.tolerance);
    vector<std::int64_t> larger;
    for (std::int64_t j = 0; j < p.terms.cols(); ++j) {
        const double uncertain =
            eps * absolute_energy(pairs, p, j) / std::fabs(pairs.values[j] - pencil.shift);
        if (!(relative[j] <= std::max(allowed, uncertain))) larger.push_back(j);
    }
    return larger;
}

Matrix chosen(const Matrix &a, const vector<std::int64_t> &columns) {
    Matrix some(a.rows(), 0);
    for (std::int64_t j : columns) some.append(a.columns(j, 1));
    return some;
}

/// Inverse iteration of some of the pairs (m_x: M times the vectors, which are orthonormal), and the Ritz
/// vectors among them: beside an eigenvalue far nearer to the shift they may have come mixed with one
/// another. K x, whose rounding beside penalties exceeds a small residual, has no part in it.
void iterate(const Pencil &pencil, const vector<std::int64_t> &some, const Matrix &m_x, EigenPairs &pairs) {
    const Matrix images = chosen(m_x, some);
    Matrix solved = images;
    pencil.factor.solve(solved);
    const SymmetricEigen ritz = symmetric_eigen(product('T', 'N', images, solved));
    const Matrix next = product('N', 'N', solved, ritz.vectors);
    const auto value = [&](std::int64_t c) { return pencil.shift + 1 / ritz.values[c]; };
    vector<std::int64_t> order(some.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return value(a) < value(b); });
    for (std::size_t c = 0; c < some.size(); ++c) {
        double *x = pairs.vectors.col(some[c]);
        const double *y = next.col(order[c]), theta = ritz.values[order[c]];
        for (std::int64_t i = 0; i < pencil.size(); ++i) x[i] = y[i] / theta;
        pairs.values[some[c]] = value(order[c]);
    }
}

} // namespace

void improve(const Pencil &pencil, EigenPairs &pairs, Matrix mx) {
    constexpr int rounds = 5;
    if (pairs.values.empty()) return;
    for (int round = 0;; ++round) {
        const Products products(pencil.k, pairs.vectors);
        take_better_values(pencil, pairs, products);
        const vector<double> relative = relative_residuals(pencil, pairs, products, mx);
        const vector<std::int64_t> large = larger_than_allowed(pencil, pairs, products, relative);
        if (large.empty()) return;
        if (round == rounds)
            throw Error(status::eigensolver,
                        format("eigenpair %lld (eigenvalue %g) has a relative residual of %g",
                               static_cast<long long>(large[0]), pairs.values[large[0]], relative[large[0]]))
                .index(large[0]);
        pairs.rest = SearchRest();
        iterate(pencil, large, mx, pairs);
        mx = orthonormalize(pencil.m, pairs.vectors);
    }
}

} // namespace plm
