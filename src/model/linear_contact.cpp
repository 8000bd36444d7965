#include "model/linear_contact.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

vector<std::int64_t> active_pairs(const vector<double> &spring) {
    vector<std::int64_t> active;
    for (std::size_t i = 0; i < spring.size(); ++i)
        if (spring[i] > 0) active.push_back(static_cast<std::int64_t>(i));
    return active;
}

} // namespace

// Works on the inverse: S = (diag(lambda) + G_A^T k G_A + sigma)^-1 = D^-1 - Y^T Y. A direct eigenproblem
// would lose the low modes to rounding (eps times the stiffest attachment vector); the compliance form keeps
// them to eps and has the rigid limit k -> infinity.
SpaceModes modes_with_springs(const Space &space, const vector<double> &spring, double upper) {
    const std::int64_t m = space.size();
    const vector<std::int64_t> active = active_pairs(spring);
    SpaceModes modes;
    if (active.empty()) {
        std::int64_t count =
            std::upper_bound(space.lambda.begin(), space.lambda.end(), upper) - space.lambda.begin();
        modes.values.assign(space.lambda.begin(), space.lambda.begin() + count);
        modes.vectors.reset(m, count);
        for (std::int64_t j = 0; j < count; ++j) modes.vectors(j, j) = 1;
        return modes;
    }
    const double sigma = space.lambda.front() > 0 ? 0.0 : space.model->shift();
    const std::int64_t n_active = static_cast<std::int64_t>(active.size());
    Matrix y(n_active, m); // G_A D^-1
    Matrix t(n_active, n_active);
    {
        Matrix root(n_active, m); // G_A D^-1/2
        for (std::int64_t j = 0; j < m; ++j) {
            const double d = space.lambda[j] + sigma;
            for (std::int64_t i = 0; i < n_active; ++i) {
                const double b = space.gap(active[i], j);
                root(i, j) = b / std::sqrt(d);
                y(i, j) = b / d;
            }
        }
        gemm('N', 'T', 1.0, root, root, 0.0, t);
    }
    for (std::int64_t i = 0; i < n_active; ++i) t(i, i) += 1 / spring[active[i]];
    Matrix inverse(m, m);
    DenseCholesky cholesky;
    if (!cholesky.factor(t))
        throw Error(PLM_ERR_SINGULAR,
                    "the contact flexibility is not positive definite; look for repeated gap rows "
                    "with infinite stiffness")
            .reason(PLM_REASON_SINGULAR);
    Matrix ty = y;
    cholesky.solve(ty.data(), m, n_active);
    gemm('T', 'N', 1.0, y, ty, 0.0, inverse);
    for (std::int64_t j = 0; j < m; ++j) {
        for (std::int64_t i = j; i < m; ++i) { // symmetrise against rounding
            const double s = 0.5 * (inverse(i, j) + inverse(j, i));
            inverse(i, j) = inverse(j, i) = s;
        }
        inverse(j, j) -=
            1 / (space.lambda[j] + sigma); // now minus the compliance: ascending = lowest modes first
    }
    SymmetricEigen eigen = std::isfinite(upper) ? symmetric_eigen_below(inverse, -1 / (upper + sigma))
                                                : symmetric_eigen(inverse);
    for (double mu : eigen.values) {
        if (!(mu < 0)) break; // compliance below rounding: no dynamics
        const double value = -1 / mu - sigma;
        modes.values.push_back(std::abs(value) < 1e-9 * sigma ? 0.0 : value);
    }
    modes.vectors = eigen.vectors.columns(0, static_cast<std::int64_t>(modes.values.size()));
    return modes;
}

namespace {

// Pivots below this share of the largest are soft: of rigid-body motion that nothing but contact holds. Their
// compliance would bury that of the springs and of the structure under its rounding.
constexpr double soft_pivot = 1e-6;

struct Coordinates {
    vector<std::int64_t> soft, firm;
};

Coordinates sorted_by_pivot(const vector<double> &pivot) {
    const double limit = soft_pivot * *std::max_element(pivot.begin(), pivot.end());
    Coordinates c;
    for (std::size_t j = 0; j < pivot.size(); ++j)
        (pivot[j] < limit ? c.soft : c.firm).push_back(static_cast<std::int64_t>(j));
    return c;
}

Matrix entries(const Matrix &a, const vector<std::int64_t> &rows, const vector<std::int64_t> &columns) {
    Matrix b(static_cast<std::int64_t>(rows.size()), static_cast<std::int64_t>(columns.size()));
    for (std::int64_t j = 0; j < b.cols(); ++j)
        for (std::int64_t i = 0; i < b.rows(); ++i) b(i, j) = a(rows[i], columns[j]);
    return b;
}

// x becomes S^-1 x for S = diag(pivot) + G^T Z, symmetric. A direction that nothing holds has the pivots
// alone, which rounding of the rest may exceed: it is held no less than that.
void solve_soft(const vector<double> &pivot, const Matrix &gap, const Matrix &z, vector<double> &x) {
    Matrix s = product('T', 'N', gap, z);
    const std::int64_t n = s.cols();
    for (std::int64_t j = 0; j < n; ++j) {
        for (std::int64_t i = j; i < n; ++i) s(i, j) = 0.5 * (s(i, j) + s(j, i));
        s(j, j) += pivot[j];
    }
    const SymmetricEigen e = symmetric_eigen(s);
    const double least = *std::min_element(pivot.begin(), pivot.end());
    vector<double> along(n, 0.0);
    gemv('T', 1.0, e.vectors, x.data(), 0.0, along.data());
    for (std::int64_t j = 0; j < n; ++j) along[j] /= std::max(e.values[j], least);
    gemv('N', 1.0, e.vectors, along.data(), 0.0, x.data());
}

} // namespace

// By the springs' forces f. Firm coordinates: D x + G^T f = b, so that T f = G D^-1 b + G_soft x_soft with
// T = 1/spring + G D^-1 G^T: stable for any spring. What is left for the soft ones has no difference of large
// numbers.
void solve_with_springs(const vector<double> &pivot, const Matrix &gap, const vector<double> &spring,
                        vector<double> &x) {
    const vector<std::int64_t> active = active_pairs(spring);
    const std::int64_t a = static_cast<std::int64_t>(active.size());
    if (a == 0) {
        for (std::size_t j = 0; j < x.size(); ++j) x[j] /= pivot[j];
        return;
    }
    const Coordinates c = sorted_by_pivot(pivot);
    const Matrix firm = entries(gap, active, c.firm), soft = entries(gap, active, c.soft);
    Matrix root = firm;
    vector<double> x_firm(c.firm.size()), x_soft(c.soft.size()), force(a, 0.0);
    for (std::size_t j = 0; j < c.firm.size(); ++j) {
        const double d = pivot[c.firm[j]];
        x_firm[j] = x[c.firm[j]] / d;
        for (std::int64_t i = 0; i < a; ++i) root(i, static_cast<std::int64_t>(j)) /= std::sqrt(d);
    }
    Matrix t = product('N', 'T', root, root);
    for (std::int64_t i = 0; i < a; ++i) t(i, i) += 1 / spring[active[i]];
    DenseCholesky cholesky;
    if (!cholesky.factor(t))
        throw Error(PLM_ERR_SINGULAR,
                    "the contact flexibility at rest is singular: two closed pairs repeat the same gap row")
            .reason(PLM_REASON_SINGULAR);
    gemv('N', 1.0, firm, x_firm.data(), 0.0, force.data());
    cholesky.solve(force.data(), 1, a);
    if (!c.soft.empty()) {
        vector<double> soft_pivots(c.soft.size());
        for (std::size_t j = 0; j < c.soft.size(); ++j)
            x_soft[j] = x[c.soft[j]], soft_pivots[j] = pivot[c.soft[j]];
        Matrix z = soft; // forces per unit of the soft coordinates
        cholesky.solve(z.data(), z.cols(), a);
        gemv('T', -1.0, soft, force.data(), 1.0, x_soft.data());
        solve_soft(soft_pivots, soft, z, x_soft);
        gemv('N', 1.0, z, x_soft.data(), 1.0, force.data());
    }
    for (std::size_t j = 0; j < c.soft.size(); ++j) x[c.soft[j]] = x_soft[j];
    for (std::size_t j = 0; j < c.firm.size(); ++j) {
        double s = 0;
        for (std::int64_t i = 0; i < a; ++i) s += firm(i, static_cast<std::int64_t>(j)) * force[i];
        x[c.firm[j]] = x_firm[j] - s / pivot[c.firm[j]];
    }
}

} // namespace plm
