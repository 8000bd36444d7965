#include "hbm/formulation.hpp"
#include <algorithm>

namespace plm {
namespace {

constexpr double stiff = 3e3; // k_n over the local stiffness: beyond, few harmonics follow their own ripples
constexpr double moderate =
    100; // e over the local stiffness: softer converges more slowly in H, stiffer takes more steps

} // namespace

double local_stiffness(const ReducedModel &m) {
    vector<double> flexibility(m.n_pairs(), 0.0);
    for (std::int64_t j = 0; j < m.static_size(); ++j) {
        if (m.lambda_0[j] <= 0) return 0;
        for (std::int64_t i = 0; i < m.n_pairs(); ++i)
            flexibility[i] += m.gap_0(i, j) * m.gap_0(i, j) / m.lambda_0[j];
    }
    if (flexibility.empty()) return 0;
    const auto middle = flexibility.begin() + static_cast<std::ptrdiff_t>(flexibility.size() / 2);
    std::nth_element(flexibility.begin(), middle, flexibility.end());
    return *middle > 0 ? 1 / *middle : 0;
}

LawForm make_formulation(const ReducedModel &m, const HbmOptions &options) {
    const bool possible = options.unknowns != NonlinearUnknowns::modal;
    if (!possible || options.formulation == FormulationKind::penalty) return penalty_form(m.contact);
    const double local = local_stiffness(m);
    if (local == 0) return penalty_form(m.contact); // which the static reference of rigid-body modes needs
    const double limit = options.formulation == FormulationKind::compliance ? moderate : stiff;
    return compliance_form(m.contact, limit * local, moderate * local);
}

namespace {

Matrix penetration(const Matrix &gap_0, const Matrix &gap, const Contact &contact, const BranchPoint &point,
                   std::int64_t n_harmonics) {
    const std::int64_t z = gap.rows(), columns = 2 * n_harmonics;
    Matrix u(z, columns + 1), eta = point.eta;
    if (z == 0) return u;
    set_harmonics(eta, n_harmonics);
    for (std::int64_t i = 0; i < z; ++i) u(i, 0) = -contact.initial_gap[i];
    gemv('N', 1.0, gap_0, point.eta_0.data(), 1.0, u.col(0));
    const Matrix dynamic = product('N', 'N', gap, eta);
    std::copy(dynamic.data(), dynamic.data() + z * columns, u.col(1));
    return u;
}

} // namespace

Matrix penetration_of(const ReducedModel &m, const BranchPoint &point, std::int64_t n_harmonics) {
    return penetration(m.gap_0, m.gap, m.contact, point, n_harmonics);
}

Matrix whole_penetration_of(const ReducedModel &m, const BranchPoint &point, std::int64_t n_harmonics) {
    return penetration(m.whole_gap_0(), m.whole_gap(), m.whole_contact(), point, n_harmonics);
}

ContactMotion contact_motion(const ReducedModel &m, const BranchPoint &point) {
    if (point.contact_stiffness) return {point.contact_motion, point.contact_stiffness.get()};
    return {penetration_of(m, point, point.n_harmonics), &m.contact.stiffness};
}

ContactMotion whole_contact_motion(const ReducedModel &m, const BranchPoint &point) {
    if (!m.all_pairs) return contact_motion(m, point);
    return {whole_penetration_of(m, point, point.n_harmonics), &m.whole_contact().stiffness};
}

} // namespace plm
