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
Matrix mass_root(const SparseMatrix &mass, const vector<std::int64_t> &massive) {
    const std::int64_t r = static_cast<std::int64_t>(massive.size());
    vector<std::int64_t> keep(mass.cols, -1);
    for (std::int64_t i = 0; i < r; ++i) keep[massive[i]] = i;
    Matrix m = to_dense(submatrix(mass, keep, r, keep, r));
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

double rayleigh_quotient(const Pencil &pencil, const Field &x) {
    return column_products(x, pencil.k.times(x))[0] / column_products(x, pencil.m.times(x))[0];
}

/// DOFs with a positive diagonal entry.
vector<std::int64_t> massive_dofs(const SparseMatrix &m) {
    vector<std::int64_t> dofs;
    for (std::int64_t j = 0; j < m.cols; ++j)
        for (std::int64_t p = m.ptr[j]; p < m.ptr[j + 1]; ++p)
            if (m.idx[p] == j && m.val[p] > 0) dofs.push_back(j);
    return dofs;
}

/// S over all DOFs.
Field spread_out(const Pencil &pencil, const Matrix &root, const vector<std::int64_t> &massive) {
    Field spread = pencil.place;
    for (std::int64_t j = 0; j < root.cols(); ++j) {
        vector<double> column(pencil.size(), 0.0);
        for (std::int64_t i = 0; i < root.rows(); ++i) column[massive[i]] = root(i, j);
        spread.append(spread.from(column));
    }
    return spread;
}

} // namespace

EigenPairs dense_eigenpairs(const Pencil &pencil, std::int64_t n_wanted) {
    const vector<std::int64_t> massive = massive_dofs(pencil.m.entries());
    const Matrix root = mass_root(pencil.m.entries(), massive); // M = S S^T
    EigenPairs pairs{{}, pencil.place, {}};
    if (root.cols() == 0) return pairs;

    // A^-1 M x = theta x with theta = 1 / (lambda - shift) becomes (S^T A^-1 S) y = theta y, x = A^-1 S y /
    // theta.
    const Field spread = spread_out(pencil, root, massive);
    pencil.poll();
    Field compliance = spread;
    pencil.factor.solve(compliance);
    const SymmetricEigen e = symmetric_eigen(block_gram(spread, compliance));
    pencil.poll();

    const double theta_max = e.values.back(), zero = 1e-16 * theta_max;
    if (!(theta_max > 0)) throw Error(status::eigensolver, "no eigenvalue lies above the shift");
    const auto finite_ones = e.values.end() - std::upper_bound(e.values.begin(), e.values.end(), zero);
    const std::int64_t count = std::min<std::int64_t>(n_wanted, finite_ones), last = root.cols() - 1;
    Matrix y(root.cols(), count);
    for (std::int64_t j = 0; j < count; ++j) std::copy_n(e.vectors.col(last - j), root.cols(), y.col(j));
    pairs.vectors = combine(compliance, y);
    vector<double> thetas;
    for (std::int64_t j = 0; j < count; ++j) thetas.push_back(e.values[last - j]);
    pairs.vectors.divide(thetas); // then x^T M x = y^T y = 1
    for (std::int64_t j = 0; j < count; ++j) {
        const double theta = thetas[j];
        // High eigenvalues have lost digits in theta; the Rayleigh quotient has the opposite strength.
        pairs.values.push_back(theta > 1e-8 * theta_max
                                   ? pencil.shift + 1 / theta
                                   : rayleigh_quotient(pencil, pairs.vectors.columns(j, 1)));
    }
    return pairs;
}

} // namespace plm
