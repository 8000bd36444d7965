#include "small_reduced.hpp"
#include "linalg/lapack.hpp"
#include <cmath>

namespace test {

using plm::Matrix;

std::shared_ptr<plm::ReducedModel> reduce_exactly(const exact::Structure &s) {
    const int n = s.n;
    Matrix k(n, n), m(n, n), c(n, n), rows(s.z, n), load(n, 1), preload(n, 1);
    for (int i = 0; i < n; ++i) {
        m(i, i) = s.mass[i];
        load(i, 0) = s.force[i];
        preload(i, 0) = s.preload.empty() ? 0 : s.preload[i];
        for (int j = 0; j < n; ++j) k(i, j) = s.stiffness[i * n + j], c(i, j) = s.damping[i * n + j];
        for (int p = 0; p < s.z; ++p) rows(p, i) = s.gap_rows[p * n + i];
    }
    const plm::SymmetricEigen modes = plm::symmetric_eigen_general(k, m);
    auto r = std::make_shared<plm::ReducedModel>();
    r->lambda = r->lambda_0 = modes.values;
    r->vectors = plm::SpaceVectors(plm::Field(modes.vectors));
    r->gap = r->gap_0 = plm::product('N', 'N', rows, modes.vectors);
    const Matrix cm = plm::product('T', 'N', modes.vectors, plm::product('N', 'N', c, modes.vectors));
    double off = 0, on = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) (i == j ? on : off) += std::abs(cm(i, j));
    if (off <= 1e-14 * on) {
        for (int i = 0; i < n; ++i) r->damping_diagonal.push_back(cm(i, i));
    } else {
        r->damping = cm;
    }
    const Matrix f = plm::product('T', 'N', modes.vectors, load),
                 f0 = plm::product('T', 'N', modes.vectors, preload);
    r->preload_0.assign(f0.data(), f0.data() + n);
    r->excitation[1].real.assign(f.data(), f.data() + n);
    r->excitation[1].imag.assign(n, 0.0);
    r->contact.stiffness.assign(s.contact_stiffness.begin(), s.contact_stiffness.end());
    r->contact.initial_gap.assign(s.gap.begin(), s.gap.end());
    return r;
}

plm::vector<double> displacement(const plm::ReducedModel &m, const plm::vector<double> &eta_0,
                                 const Matrix &eta, std::int64_t dof) {
    plm::vector<double> q(eta.cols() + 1, 0.0);
    for (std::int64_t j = 0; j < m.size(); ++j) {
        q[0] += m.vectors.formed().at(dof, j) * eta_0[j];
        for (std::int64_t c = 0; c < eta.cols(); ++c) q[c + 1] += m.vectors.formed().at(dof, j) * eta(j, c);
    }
    return q;
}

exact::Structure bilinear_oscillator(double zeta, double contact_stiffness, double gap, double force,
                                     double preload) {
    exact::Structure s;
    s.n = s.z = 1;
    s.mass = {1};
    s.stiffness = {1};
    s.damping = {2 * zeta};
    s.gap_rows = {1};
    s.contact_stiffness = {contact_stiffness};
    s.gap = {gap};
    s.force = {force};
    s.preload = {preload};
    return s;
}

exact::Structure chain(int n, double zeta, double contact_stiffness, double gap, double force, double preload,
                       const std::vector<int> &pairs) {
    exact::Structure s;
    s.n = n;
    s.z = static_cast<int>(pairs.size());
    s.mass.assign(n, 1.0);
    s.stiffness.assign(n * n, 0.0);
    for (int i = 0; i < n; ++i) {
        s.stiffness[i * n + i] = i + 1 < n ? 2 : 1;
        if (i > 0) s.stiffness[i * n + i - 1] = s.stiffness[(i - 1) * n + i] = -1;
    }
    const double first = 2 * std::sin(M_PI / (2 * (2 * n + 1))); // lowest frequency of the fixed-free chain
    s.damping = s.stiffness;
    for (double &c : s.damping) c *= 2 * zeta / first;
    s.gap_rows.assign(s.z * n, 0.0);
    for (int p = 0; p < s.z; ++p) {
        s.gap_rows[p * n + pairs[p]] = 1;
        if (pairs[p] + 1 < n) s.gap_rows[p * n + pairs[p] + 1] = -1;
    }
    s.contact_stiffness.assign(s.z, contact_stiffness);
    s.gap.assign(s.z, gap);
    s.force.assign(n, 0.0);
    s.force[n - 1] = force;
    s.preload.assign(n, 0.0);
    s.preload[n - 1] = preload;
    return s;
}

} // namespace test
