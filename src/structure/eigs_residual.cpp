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
Field orthonormalize(const TallMatrix &m, Field &x) {
    Field mx = m.times(x);
    Matrix gram = block_gram(x, mx);
    const blas_int count = to_blas(x.cols());
    if (x.empty()) return mx;
    require_finite(gram.data(), gram.rows() * gram.cols(), "eigensolver, Gram matrix");
    blas_int info = 0;
    dpotrf_("L", &count, gram.data(), &count, &info, 1);
    if (info != 0)
        throw Error(status::eigensolver, "the eigenvectors found are linearly dependent").library_code(info);
    x.divide('L', true, gram);
    mx.divide('L', true, gram);
    return mx;
}

namespace {

/// The share of K X - M X diag(lambda) in the size of its terms that rounding of K X, which counts in its own
/// row only, does not explain.
vector<double> relative_residuals(const Pencil &pencil, const EigenPairs &pairs, const PairProducts &p,
                                  const Field &mx) {
    constexpr double rounding = 1e-12;
    const vector<double> inertia = column_norms(mx);
    vector<double> relative;
    for (std::int64_t j = 0; j < mx.cols(); ++j) {
        const double lambda = pairs.values[j];
        relative.push_back(p.residual(j, lambda, mx, rounding) /
                           ((std::fabs(lambda) + std::fabs(lambda - pencil.shift)) * inertia[j]));
    }
    return relative;
}

/// Beside a far smaller eigenvalue theta = 1 / (lambda - shift) leaves a value few digits: then its Rayleigh
/// quotient has more. Beside penalties rounding of the factor and of K x leaves few to both: then it is
/// summed with more.
void take_better_values(const Pencil &pencil, EigenPairs &pairs, const PairProducts &p) {
    constexpr double eps = std::numeric_limits<double>::epsilon(), certain = 1e-9;
    const double first = std::fabs(pairs.values[0] - pencil.shift);
    for (std::int64_t j = 0; j < pairs.vectors.cols(); ++j) {
        const double apart = std::fabs(pairs.values[j] - pencil.shift);
        const double terms = p.terms(j);
        if (eps * terms > certain * std::fabs(pairs.values[j]))
            pairs.values[j] = p.precise_energy(j);
        else if (apart * (apart / first) > terms)
            pairs.values[j] = p.energy(j);
    }
}

/// No pair is more certain than rounding of K leaves its value above the shift.
vector<std::int64_t> larger_than_allowed(const Pencil &pencil, const EigenPairs &pairs, const PairProducts &p,
                                         const vector<double> &relative) {
    constexpr double eps = std::numeric_limits<double>::epsilon();
    const double allowed = std::max(1e-6, 100 * pencil.options.tolerance);
    vector<std::int64_t> larger;
    for (std::int64_t j = 0; j < pairs.vectors.cols(); ++j) {
        const double uncertain = eps * p.terms(j) / std::fabs(pairs.values[j] - pencil.shift);
        if (!(relative[j] <= std::max(allowed, uncertain))) larger.push_back(j);
    }
    return larger;
}

/// Inverse iteration of some of the pairs (m_x: M times the vectors, which are orthonormal), and the Ritz
/// vectors among them: beside an eigenvalue far nearer to the shift they may have come mixed with one
/// another. K x, whose rounding beside penalties exceeds a small residual, has no part in it.
void iterate(const Pencil &pencil, const vector<std::int64_t> &some, const Field &m_x, EigenPairs &pairs) {
    const Field images = m_x.columns(some);
    Field solved = images;
    pencil.factor.solve(solved);
    const SymmetricEigen ritz = symmetric_eigen(block_gram(images, solved));
    const auto value = [&](std::int64_t c) { return pencil.shift + 1 / ritz.values[c]; };
    vector<std::int64_t> order(some.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return value(a) < value(b); });
    Field next = combine(solved, ritz.vectors).columns(order);
    vector<double> theta;
    for (std::int64_t c : order) theta.push_back(ritz.values[c]);
    next.divide(theta);
    for (std::size_t c = 0; c < some.size(); ++c) {
        pairs.vectors.put(some[c], next.columns(static_cast<std::int64_t>(c), 1));
        pairs.values[some[c]] = value(order[c]);
    }
}

} // namespace

void improve(const Pencil &pencil, EigenPairs &pairs, Field mx) {
    constexpr int rounds = 5;
    if (pairs.values.empty()) return;
    for (int round = 0;; ++round) {
        const std::unique_ptr<PairProducts> products = pencil.k.products(pairs.vectors);
        take_better_values(pencil, pairs, *products);
        const vector<double> relative = relative_residuals(pencil, pairs, *products, mx);
        const vector<std::int64_t> large = larger_than_allowed(pencil, pairs, *products, relative);
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
