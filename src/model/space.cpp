#include "model/space.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

vector<double> project(const Matrix &v, const vector<double> &f) {
    vector<double> y(v.cols(), 0.0);
    if (!f.empty()) gemv('T', 1.0, v, f.data(), 0.0, y.data());
    return y;
}

// Rayleigh and modal damping are diagonal here because V diagonalises M and K and starts with the exact
// modes.
vector<double> diagonal_damping(const Space &space, const Damping &damping) {
    vector<double> c(space.size());
    for (std::int64_t j = 0; j < space.size(); ++j) {
        c[j] = damping.alpha + damping.beta * space.lambda[j];
        if (damping.modal_ratio.empty()) continue;
        std::int64_t last = static_cast<std::int64_t>(damping.modal_ratio.size()) - 1;
        c[j] += 2 * damping.modal_ratio[std::min(j, last)] * std::sqrt(space.lambda[j]);
    }
    return c;
}

} // namespace

void project_onto(Space &space) {
    const Model &model = *space.model;
    space.gap = multiply(model.gap_matrix(), space.vectors);
    space.damping_diagonal = diagonal_damping(space, model.damping());
    if (model.damping().has_matrix) {
        space.damping = product('T', 'N', space.vectors, multiply(model.damping_matrix(), space.vectors));
        for (std::int64_t j = 0; j < space.size(); ++j) space.damping(j, j) += space.damping_diagonal[j];
        space.damping_diagonal.clear();
    }
    if (model.has_preload()) space.preload = project(space.vectors, model.preload());
    for (const auto &[harmonic, load] : model.excitation()) {
        HarmonicLoad &reduced = space.excitation[harmonic];
        reduced.real = project(space.vectors, load.real);
        if (harmonic > 0) reduced.imag = project(space.vectors, load.imag);
    }
}

// Works on the inverse: S = (diag(lambda) + G_A^T k G_A + sigma)^-1 = D^-1 - Y^T Y. A direct eigenproblem
// would lose the low modes to rounding (eps times the stiffest attachment vector); the compliance form keeps
// them to eps and has the rigid limit k -> infinity.
SpaceModes modes_of_contact_set(const Space &space, const vector<char> &closed, double upper) {
    const std::int64_t m = space.size(), z = space.n_pairs();
    const vector<double> &stiffness = space.model->contact_stiffness();
    vector<std::int64_t> active;
    for (std::int64_t i = 0; i < z; ++i)
        if (closed[i]) active.push_back(i);
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
    for (std::int64_t i = 0; i < n_active; ++i) t(i, i) += 1 / stiffness[active[i]];
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

} // namespace plm
