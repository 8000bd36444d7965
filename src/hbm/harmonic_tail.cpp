#include "hbm/harmonic_tail.hpp"
#include "contact/contact_force.hpp"
#include "hbm/receptance.hpp"
#include "motions/penetration.hpp"
#include "paths/metric.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

double norm_of_harmonics(const Matrix &u, std::int64_t first, std::int64_t last) {
    return first > last ? 0 : norm2(u.rows() * 2 * (last - first + 1), u.col(2 * first - 1));
}

// Reduced response of one harmonic to its contact force and `force_scale` times the excitation.
void respond(const ReducedModel &m, std::int64_t h, double omega, std::int64_t multiple, const Matrix &force,
             double force_scale, double *cosine, double *sine) {
    const std::int64_t r = m.size();
    vector<double> c(r), s(r);
    gemv('T', -1.0, m.gap, force.col(2 * h - 1), 0.0, c.data());
    gemv('T', -1.0, m.gap, force.col(2 * h), 0.0, s.data());
    vector<std::complex<double>> v(r);
    for (std::int64_t j = 0; j < r; ++j) v[j] = {c[j], -s[j]};
    for (const auto &[part, load] : m.excitation)
        for (std::int64_t j = 0; part.harmonic * multiple == h && j < r; ++j)
            v[j] += force_scale * part.growth(omega) * std::complex<double>(load.real[j], load.imag[j]);
    Receptance receptance;
    receptance.update(m, h, omega / static_cast<double>(multiple));
    receptance.apply(v.data());
    for (std::int64_t j = 0; j < r; ++j) {
        cosine[j] = v[j].real();
        sine[j] = -v[j].imag();
    }
}

// The contact forces of harmonics 0 ... `solved` with the tail less those without. u and `force`, padded to
// as many harmonics as the tail has, are overwritten.
Matrix change_by(const Matrix &tail, const ReducedModel &m, const vector<double> &stiffness,
                 std::int64_t solved, Matrix &u, Matrix &force) {
    const std::int64_t z = m.n_pairs(), known = 2 * solved + 1;
    Matrix change(z, known);
    for (std::int64_t k = 0; k < change.rows() * known; ++k) change.data()[k] = -force.data()[k];
    for (std::int64_t k = known; k < u.cols(); ++k)
        for (std::int64_t i = 0; i < z; ++i) { // in compliance form the unknowns hold the slack, too
            const double slack = 1 / stiffness[i] - 1 / m.contact.stiffness[i];
            u(i, k) = tail(i, k - known) + slack * force(i, k);
        }
    ContactIndicator indicator;
    make_event_force(u.cols() / 2, z)->indicator(u, indicator);
    apply_indicator(indicator, stiffness, u, force);
    for (std::int64_t k = 0; k < z * known; ++k) change.data()[k] += force.data()[k];
    return change;
}

// Newton's step for a change of the contact forces, less what lies along the curve's tangent. Lengths are
// measured by the solution and the frequency themselves.
PathState across_curve(HbmSystem &system, const double *x, double omega, const Matrix &force_change) {
    vector<double> change(system.size());
    system.contact_force_change(force_change, change.data());
    system.solve(change.data(), 1);
    const double size = norm2(system.size(), x);
    return step_across({size > 0 ? size : 1, omega}, tangent_at(system), change);
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
        respond(m, h, p.omega, multiple, force, p.force_scale, content.tail_response.col(column),
                content.tail_response.col(column + 1));
    }
    const double motion = norm_of_harmonics(u, 1, solved);
    if (motion == 0) return content;
    const Matrix tail = product('N', 'N', m.gap, content.tail_response);
    content.tail = norm2(tail.rows() * tail.cols(), tail.data()) / motion;
    content.top = norm_of_harmonics(u, solved - (2 * solved) / 5 + 1, solved) / motion;
    content.force_change = change_by(tail, m, *contact.stiffness, solved, u, force);
    return content;
}

HarmonicChange harmonic_change(const ReducedModel &m, const BranchPoint &point, std::int64_t multiple,
                               const HarmonicContent &content, HbmSystem &system, const double *x) {
    const std::int64_t solved = point.n_harmonics, r = m.size();
    HarmonicChange out;
    out.motion.reset(r, 2 * (2 * solved + 2));
    if (content.force_change.cols() == 0) return out;
    const PathState change = across_curve(system, x, point.omega, content.force_change);
    out.shift = change.parameter / point.omega;
    Matrix u, force;
    system.contact_motion_change(change.x.data(), u);
    const ContactMotion contact = contact_motion(m, point);
    apply_indicator(system.indicator(), *contact.stiffness, u, force);
    for (std::int64_t k = 0; k < force.rows() * force.cols(); ++k)
        force.data()[k] += content.force_change.data()[k];
    for (std::int64_t h = 1; h <= solved; ++h)
        respond(m, h, point.omega, multiple, force, 0.0, out.motion.col(2 * h - 2),
                out.motion.col(2 * h - 1));
    const Matrix &tail = content.tail_response;
    std::copy(tail.data(), tail.data() + r * tail.cols(), out.motion.col(2 * solved));
    return out;
}

namespace {

double norm_of_row(const Matrix &a, std::int64_t row) {
    double size = 0;
    for (std::int64_t c = 0; c < a.cols(); ++c) size = std::hypot(size, a(row, c));
    return size;
}

// Rows of P at the DOFs that the pairs of the equations hold.
Matrix contact_rows(const ReducedModel &m) {
    if (!m.model || m.vectors.rows() != m.model->n_free()) return Matrix();
    const GapRows &gap = m.model->gap_rows();
    return m.vectors.rows_at(m.all_pairs ? gap.dofs_of(m.carried) : gap.dofs());
}

double largest_at_contact(const ReducedModel &m, const Matrix &motion, const Matrix &change) {
    const Matrix rows = contact_rows(m);
    if (rows.rows() == 0) return 0;
    const Matrix moves = product('N', 'N', rows, motion), changes = product('N', 'N', rows, change);
    vector<double> size(rows.rows());
    for (std::int64_t i = 0; i < rows.rows(); ++i) size[i] = norm_of_row(moves, i);
    const double least = least_motion * *std::max_element(size.begin(), size.end());
    double worst = 0;
    for (std::int64_t i = 0; i < rows.rows() && least > 0; ++i)
        worst = std::max(worst, norm_of_row(changes, i) / std::max(least, size[i]));
    return worst;
}

} // namespace

double harmonic_error(const ReducedModel &m, const BranchPoint &point, const HarmonicChange &change) {
    const Matrix motion = point.eta.columns(0, 2 * point.n_harmonics);
    const double size = norm2(motion.rows() * motion.cols(), motion.data());
    if (size == 0) return 0;
    const double whole = norm2(change.motion.rows() * change.motion.cols(), change.motion.data()) / size;
    return std::max({whole, std::abs(change.shift), largest_at_contact(m, motion, change.motion)});
}

double harmonic_error_at(const ReducedModel &m, const BranchPoint &point, const HarmonicChange &change,
                         std::int64_t dof, Measure measure, std::int64_t harmonic) {
    const DofTerms row = m.model->terms(dof);
    if (row.empty()) return 0;
    const bool one = measure == Measure::harmonic && harmonic > 0;
    const vector<double> p = m.vectors.row(row);
    const auto size = [&](const Matrix &eta, std::int64_t n, const KnownMotion &known) {
        vector<double> motion(2 * n);
        for (const auto &[h, u] : known) {
            const std::int64_t at = h * point.period_multiple;
            if (at <= n && (!one || at == harmonic))
                motion[2 * at - 2] = u.real(), motion[2 * at - 1] = -u.imag();
        }
        for (std::int64_t c = one ? 2 * harmonic - 2 : 0; c < 2 * (one ? std::min(harmonic, n) : n); ++c)
            for (std::int64_t j = 0; j < m.size(); ++j) motion[c] += p[j] * eta(j, c);
        return norm2(2 * n, motion.data());
    };
    const double motion = size(point.eta, point.n_harmonics,
                               m.model->known_motion(dof, point.omega, point.force_scale)),
                 moved = size(change.motion, change.motion.cols() / 2, {});
    return std::max(motion > 0 ? moved / motion : 0, std::abs(change.shift));
}

} // namespace plm
