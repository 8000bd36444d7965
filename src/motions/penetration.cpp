#include "motions/penetration.hpp"

namespace plm {
namespace {

Matrix penetration(const Matrix &gap_0, const Matrix &gap, const Contact &contact, const BranchPoint &point,
                   std::int64_t n_harmonics) {
    const std::int64_t z = gap.rows(), columns = 2 * n_harmonics;
    Matrix u(z, columns + 1), eta = point.eta;
    if (z == 0) return u;
    set_harmonics(eta, n_harmonics);
    gemv('N', 1.0, gap_0, point.eta_0.data(), 0.0, u.col(0));
    const Matrix dynamic = product('N', 'N', gap, eta),
                 gaps = contact.gaps(n_harmonics, point.omega, point.force_scale, point.period_multiple);
    std::copy(dynamic.data(), dynamic.data() + z * columns, u.col(1));
    for (std::int64_t k = 0; k < z * (columns + 1); ++k) u.data()[k] -= gaps.data()[k];
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
