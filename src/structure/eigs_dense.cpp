// Dense eigenproblem of order rank(M): no iteration, hence the fallback for small, fully wanted and nearly
// mass-less pencils.
#include "linalg/blas_lapack.hpp"
#include "linalg/lapack.hpp"
#include "structure/eigs_internal.hpp"
#include <algorithm>

namespace plm {
namespace {

/// S (rank x r) with M = S S^T on the massive DOFs. M is scaled to unit diagonal before its null space is cut
/// off, since masses and rotary inertias may differ by many orders of magnitude.
Matrix mass_root(const Pencil &pencil) {
    const std::int64_t r = pencil.rank();
    vector<std::int64_t> keep(pencil.size(), -1);
    for (std::int64_t i = 0; i < r; ++i) keep[pencil.massive[i]] = i;
    Matrix m = to_dense(submatrix(pencil.m, keep, r, keep, r));
    vector<double> scale(r);
    for (std::int64_t i = 0; i < r; ++i) scale[i] = std::sqrt(m(i, i));
    for (std::int64_t j = 0; j < r; ++j)
        for (std::int64_t i = 0; i < r; ++i) m(i, j) /= scale[i] * scale[j];
    const SymmetricEigen e = symmetric_eigen(m);
    const double cut = 1e-14 * static_cast<double>(r);
    const auto first = std::upper_bound(e.values.begin(), e.values.end(), cut) - e.values.begin();
    Matrix root = e.vectors.columns(first, r - first);
    for (std::int64_t j = 0; j < root.cols(); ++j)
        for (std::int64_t i = 0; i < r; ++i) root(i, j) *= scale[i] * std::sqrt(e.values[first + j]);
    return root;
}

double rayleigh_quotient(const Pencil &pencil, const double *x) {
    vector<double> y(pencil.size());
    multiply_transposed(pencil.k, x, y.data());
    const double stiffness = dot(pencil.size(), x, y.data());
    multiply_transposed(pencil.m, x, y.data());
    return stiffness / dot(pencil.size(), x, y.data());
}

} // namespace

EigenPairs dense_eigenpairs(const Pencil &pencil, std::int64_t n_wanted) {
    const std::int64_t n = pencil.size();
    const Matrix root = mass_root(pencil); // M = S S^T
    EigenPairs pairs{{}, Matrix(n, 0), {}};
    if (root.cols() == 0) return pairs;

    // A^-1 M x = theta x with theta = 1 / (lambda - shift) becomes (S^T A^-1 S) y = theta y, x = A^-1 S y /
    // theta.
    Matrix spread(n, root.cols());
    for (std::int64_t j = 0; j < root.cols(); ++j)
        for (std::int64_t i = 0; i < root.rows(); ++i) spread(pencil.massive[i], j) = root(i, j);
    pencil.poll();
    Matrix compliance = spread;
    pencil.factor.solve(compliance);
    const SymmetricEigen e = symmetric_eigen(product('T', 'N', spread, compliance));
    pencil.poll();

    const double theta_max = e.values.back(), zero = 1e-16 * theta_max;
    if (!(theta_max > 0)) throw Error(status::eigensolver, "no eigenvalue lies above the shift");
    const auto finite_ones = e.values.end() - std::upper_bound(e.values.begin(), e.values.end(), zero);
    const std::int64_t count = std::min<std::int64_t>(n_wanted, finite_ones), last = root.cols() - 1;
    Matrix y(root.cols(), count);
    for (std::int64_t j = 0; j < count; ++j) std::copy_n(e.vectors.col(last - j), root.cols(), y.col(j));
    pairs.vectors = product('N', 'N', compliance, y);
    for (std::int64_t j = 0; j < count; ++j) {
        const double theta = e.values[last - j];
        double *x = pairs.vectors.col(j);
        for (std::int64_t i = 0; i < n; ++i) x[i] /= theta; // then x^T M x = y^T y = 1
        // High eigenvalues have lost digits in theta; the Rayleigh quotient has the opposite strength.
        pairs.values.push_back(theta > 1e-8 * theta_max ? pencil.shift + 1 / theta
                                                        : rayleigh_quotient(pencil, x));
    }
    return pairs;
}

} // namespace plm
