#include "hbm/harmonic_tail.hpp"
#include "hbm/contact_force.hpp"
#include "hbm/formulation.hpp"
#include "hbm/receptance.hpp"
#include <cmath>

namespace plm {
namespace {

double norm_of_harmonics(const Matrix &u, std::int64_t first, std::int64_t last) {
    return first > last ? 0 : norm2(u.rows() * 2 * (last - first + 1), u.col(2 * first - 1));
}

// Reduced response of one harmonic to its contact force and excitation.
void respond(const ReducedModel &m, std::int64_t h, const BranchPoint &p, std::int64_t multiple,
             const Matrix &force, double *cosine, double *sine) {
    const std::int64_t r = m.size();
    vector<double> c(r), s(r);
    gemv('T', -1.0, m.gap, force.col(2 * h - 1), 0.0, c.data());
    gemv('T', -1.0, m.gap, force.col(2 * h), 0.0, s.data());
    vector<std::complex<double>> v(r);
    for (std::int64_t j = 0; j < r; ++j) v[j] = {c[j], -s[j]};
    const auto load = m.excitation.find(static_cast<int>(h / multiple));
    if (h % multiple == 0 && load != m.excitation.end())
        for (std::int64_t j = 0; j < r; ++j)
            v[j] += p.force_scale * std::complex<double>(load->second.real[j], load->second.imag[j]);
    Receptance receptance;
    receptance.update(m, h, p.omega / static_cast<double>(multiple));
    receptance.apply(v.data());
    for (std::int64_t j = 0; j < r; ++j) {
        cosine[j] = v[j].real();
        sine[j] = -v[j].imag();
    }
}

} // namespace

HarmonicContent harmonic_content(const ReducedModel &m, const BranchPoint &p, std::int64_t multiple) {
    HarmonicContent content;
    const std::int64_t z = m.n_pairs(), solved = p.n_harmonics, n = 2 * solved + 2;
    content.tail_response.reset(m.size(), 2 * (solved + 2));
    if (z == 0) return content;
    const ContactMotion contact = contact_motion(m, p);
    Matrix u(z, 2 * n + 1);
    std::copy(contact.u.data(), contact.u.data() + z * (2 * solved + 1), u.data());
    ContactIndicator indicator;
    Matrix force;
    make_event_force(n, z)->indicator(u, indicator);
    apply_indicator(indicator, *contact.stiffness, u, force);
    for (std::int64_t h = solved + 1; h <= n; ++h) {
        const std::int64_t column = 2 * (h - solved - 1);
        respond(m, h, p, multiple, force, content.tail_response.col(column), content.tail_response.col(column + 1));
    }
    const double motion = norm_of_harmonics(u, 1, solved);
    if (motion == 0) return content;
    const Matrix tail = product('N', 'N', m.gap, content.tail_response);
    content.tail = norm2(tail.rows() * tail.cols(), tail.data()) / motion;
    content.top = norm_of_harmonics(u, solved - (2 * solved) / 5 + 1, solved) / motion;
    return content;
}

} // namespace plm
