#include "sampling/static_offset.hpp"
#include "linalg/lapack.hpp"
#include <cmath>

namespace plm {
namespace {

// The open structure as its contact sees it: flexibility of the pairs and their motion in the rigid-body
// modes.
struct ContactFlexibility {
    Matrix flexible; // R = G_f diag(1 / lambda_f) G_f^T
    Matrix rigid;    // G_r
};

ContactFlexibility contact_flexibility(const Space &space) {
    std::int64_t n_rigid = 0;
    while (n_rigid < space.size() && space.lambda[n_rigid] == 0) ++n_rigid;
    ContactFlexibility f;
    f.rigid = space.gap.columns(0, n_rigid);
    Matrix scaled = space.gap.columns(n_rigid, space.size() - n_rigid);
    for (std::int64_t j = 0; j < scaled.cols(); ++j)
        for (std::int64_t i = 0; i < scaled.rows(); ++i) scaled(i, j) /= std::sqrt(space.lambda[n_rigid + j]);
    f.flexible = product('N', 'T', scaled, scaled);
    return f;
}

// x = T^+ x for a positive semi-definite T: motions that no pair resists are deflated.
void solve_deflated(const Matrix &t, vector<double> &x) {
    const SymmetricEigen eigen = symmetric_eigen(t);
    const double least = 1e-10 * eigen.values.back();
    vector<double> y(x.size(), 0.0);
    gemv('T', 1.0, eigen.vectors, x.data(), 0.0, y.data());
    for (std::size_t j = 0; j < y.size(); ++j) y[j] = eigen.values[j] > least ? y[j] / eigen.values[j] : 0.0;
    gemv('N', 1.0, eigen.vectors, y.data(), 0.0, x.data());
}

// The springs' forces s = k u with every pair coupled, under contact forces d, from
//     (1/k + R) s - G_r x_r = -R d,   G_r^T s = -G_r^T d.
// In this form nothing is lost for very stiff or very soft springs.
vector<double> sliding_forces(const ContactFlexibility &f, const vector<double> &stiffness,
                              const vector<double> &d, const vector<double> &opening) {
    const std::int64_t z = f.flexible.rows(), r = f.rigid.cols();
    Matrix a = f.flexible;
    for (std::int64_t i = 0; i < z; ++i) a(i, i) += 1 / stiffness[i];
    DenseCholesky cholesky;
    if (!cholesky.factor(a))
        throw Error(PLM_ERR_SINGULAR,
                    "the contact flexibility of the sliding system is not positive definite")
            .reason(PLM_REASON_SINGULAR);
    vector<double> s(opening);
    cholesky.solve(s.data(), 1, z);
    if (r == 0) return s;
    Matrix response = f.rigid; // A^-1 G_r
    cholesky.solve(response.data(), r, z);
    vector<double> x(r, 0.0); // T x_r = -G_r^T (d + A^-1 opening)
    gemv('T', -1.0, f.rigid, d.data(), 0.0, x.data());
    gemv('T', -1.0, f.rigid, s.data(), 1.0, x.data());
    solve_deflated(product('T', 'N', f.rigid, response), x);
    gemv('N', 1.0, response, x.data(), 1.0, s.data());
    return s;
}

} // namespace

vector<double> static_offset(const Space &space, LinearSystem system,
                             const vector<double> &mode_penetration) {
    const std::int64_t z = space.n_pairs();
    const ContactFlexibility f = contact_flexibility(space);
    vector<double> d(z), opening(z, 0.0);
    for (std::int64_t i = 0; i < z; ++i) d[i] = std::abs(mode_penetration[i]); // F_A = |dV|, F_B = -F_A
    gemv('N', -1.0, f.flexible, d.data(), 0.0, opening.data());
    if (system != LinearSystem::sliding) return opening;
    const vector<double> &stiffness = space.model->contact_stiffness();
    vector<double> offset = sliding_forces(f, stiffness, d, opening);
    for (std::int64_t i = 0; i < z; ++i) offset[i] /= stiffness[i];
    return offset;
}

} // namespace plm
