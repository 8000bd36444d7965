#include "motions/penetration.hpp"

namespace plm {
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
