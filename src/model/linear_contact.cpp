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

// In compliance form, D^-1 - Y^T T^-1 Y with T = 1/spring + G_A D^-1 G_A^T: stable for any spring.
void solve_with_springs(const vector<double> &pivot, const Matrix &gap, const vector<double> &spring,
                        vector<double> &x) {
    const vector<std::int64_t> active = active_pairs(spring);
    const std::int64_t a = static_cast<std::int64_t>(active.size()), m = gap.cols();
    for (std::int64_t j = 0; j < m; ++j) x[j] /= pivot[j];
    if (a == 0) return;
    Matrix root(a, m), t(a, a);
    for (std::int64_t j = 0; j < m; ++j)
        for (std::int64_t i = 0; i < a; ++i) root(i, j) = gap(active[i], j) / std::sqrt(pivot[j]);
    gemm('N', 'T', 1.0, root, root, 0.0, t);
    for (std::int64_t i = 0; i < a; ++i) t(i, i) += 1 / spring[active[i]];
    DenseCholesky cholesky;
    if (!cholesky.factor(t))
        throw Error(PLM_ERR_SINGULAR,
                    "the contact flexibility at rest is singular: two closed pairs repeat the same gap row")
            .reason(PLM_REASON_SINGULAR);
    vector<double> y(a, 0.0);
    for (std::int64_t j = 0; j < m; ++j)
        for (std::int64_t i = 0; i < a; ++i) y[i] += gap(active[i], j) * x[j];
    cholesky.solve(y.data(), 1, a);
    for (std::int64_t j = 0; j < m; ++j) {
        double s = 0;
        for (std::int64_t i = 0; i < a; ++i) s += gap(active[i], j) * y[i];
        x[j] -= s / pivot[j];
    }
}

} // namespace plm
