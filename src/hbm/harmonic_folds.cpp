#include "hbm/harmonic_folds.hpp"
#include "contact/penetration_zeros.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "hbm/solved_point.hpp"
#include "motions/response_at_force.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

FoldSystem::FoldSystem(HbmSystem &inner, std::shared_ptr<const ReducedModel> reduced,
                       const BranchPoint &about, double unit)
    : FreeFrequency(about.omega, unit, inner), reduced_(std::move(reduced)), y_(inner.size() + 1),
      scratch_(inner.size()) {
    choose_borders(about);
}

// b and c near the left and right null vectors, by inverse iteration.
void FoldSystem::choose_borders(const BranchPoint &about) {
    const std::int64_t n = inner_.size();
    inner_.set_force_scale(about.force_scale);
    inner_.from_point(about, y_.data());
    inner_.residual(y_.data(), about.omega, scratch_.data());
    inner_.factor_bordered(Border(), linear_);
    border_.reset(n, 1);
    double *b = border_.columns.data(), *c = border_.rows.data();
    std::fill(b, b + n, 1.0);
    std::fill(c, c + n, 1.0);
    for (int k = 0; k < 4; ++k) {
        linear_.solve_transposed(b, 1);
        linear_.solve(c, 1);
        const double left = norm2(n, b), right = norm2(n, c);
        for (std::int64_t i = 0; i < n; ++i) b[i] /= left, c[i] /= right;
    }
    for (std::int64_t i = 0; i < n; ++i) b[i] *= about.omega * about.omega; // like the other equations
}

void FoldSystem::factor_matrix() {
    inner_.factor_bordered(border_, bordered_);
    fresh_ = true;
}

void FoldSystem::residual(const double *y, double force, double *r) {
    const std::int64_t n = inner_.size();
    y_.assign(y, y + n + 1);
    inner_.set_force_scale(force);
    inner_.residual(y, omega_of(y), r);
    factor_matrix();
    v_.assign(n + 1, 0.0);
    v_[n] = 1;
    bordered_.solve(v_.data(), 1);
    r[n] = v_[n];
}

void FoldSystem::linearize() {
    const std::int64_t n = inner_.size();
    if (!fresh_) factor_matrix();
    std::swap(linear_, bordered_);
    fresh_ = false;
    null_ = v_;
    vector<double> w(n + 1, 0.0);
    w[n] = 1;
    linear_.solve_transposed(w.data(), 1);
    gradient_ = contact_gradient(w, v_);
    gradient_.push_back(-dot(n, w.data(), frequency_derivative(v_).data()) / unit());
    frequency_.assign(n + 1, 0.0);
    inner_.parameter_derivative(frequency_.data());
    for (std::int64_t i = 0; i < n; ++i) frequency_[i] /= -unit();
    linear_.solve(frequency_.data(), 1);
    determinant_ = null_[n] * (dot(n, gradient_.data(), frequency_.data()) + gradient_[n]) -
                   frequency_[n] * dot(n, gradient_.data(), null_.data());
}

// x = a + beta v + s z with (a, alpha) = M^-1 (r, 0): J x + s dR/dy_omega = r asks for
// alpha + beta g + s zeta = 0, the last equation for dg/dy . (x, s) = r_last.
void FoldSystem::solve(double *b, std::int64_t columns) {
    const std::int64_t n = inner_.size();
    const double gv = dot(n, gradient_.data(), null_.data()),
                 gz = dot(n, gradient_.data(), frequency_.data()) + gradient_[n];
    for (std::int64_t k = 0; k < columns; ++k) {
        double *x = b + k * (n + 1);
        const double last = x[n];
        x[n] = 0;
        linear_.solve(x, 1);
        const double first = -x[n], second = last - dot(n, gradient_.data(), x);
        const double beta = (first * gz - frequency_[n] * second) / determinant_,
                     s = (null_[n] * second - gv * first) / determinant_;
        for (std::int64_t i = 0; i < n; ++i) x[i] += beta * null_[i] + s * frequency_[i];
        x[n] = s;
    }
}

int FoldSystem::determinant_sign() const {
    return determinant_ < 0 ? -linear_.determinant_sign() : linear_.determinant_sign();
}

// (dJ/domega) v: dR/domega is linear in x and the same matrix.
vector<double> FoldSystem::frequency_derivative(const vector<double> &v) {
    vector<double> change(inner_.size());
    inner_.residual(v.data(), omega_of(y_.data()), scratch_.data());
    inner_.parameter_derivative(change.data());
    inner_.residual(y_.data(), omega_of(y_.data()), scratch_.data());
    return change;
}

// Z x (2H + 1) coefficients of the gaps for unknowns x, without the initial gap; the harmonics times
// `factor`.
Matrix FoldSystem::gap_motion(const vector<double> &x, double factor) const {
    const ReducedModel &m = *reduced_;
    const std::int64_t z = m.n_pairs(), r = m.size(), columns = (inner_.size() - m.static_size()) / r;
    Matrix eta(r, columns), u(z, columns + 1), dynamic(z, columns);
    std::copy(x.data() + m.static_size(), x.data() + inner_.size(), eta.data());
    gemv('N', 1.0, m.gap_0, x.data(), 0.0, u.col(0));
    gemm('N', 'N', factor, m.gap, eta, 0.0, dynamic);
    std::copy(dynamic.data(), dynamic.data() + z * columns, u.col(1));
    return u;
}

// dg = -d(w^T J v), the mean over the period of k_n ds W V with ds = du / |u'| at each switching instant; the
// residual of a harmonic is twice a mean, so that w's harmonics count twice in W(t).
vector<double> FoldSystem::contact_gradient(const vector<double> &w, const vector<double> &v) const {
    const ReducedModel &m = *reduced_;
    const std::int64_t z = m.n_pairs(), r = m.size();
    vector<double> gradient(inner_.size(), 0.0);
    if (z == 0) return gradient;
    Matrix u = gap_motion(y_, 1);
    for (std::int64_t i = 0; i < z; ++i) u(i, 0) -= m.contact.initial_gap[i];
    const SwitchingInstants switching = switching_instants(u);
    const Matrix ut = u.transposed(), vt = gap_motion(v, 1).transposed(), wt = gap_motion(w, 2).transposed();
    const std::int64_t columns = u.cols() - 1, h = columns / 2;
    Matrix change(z, columns + 1);
    for (std::int64_t i = 0; i < z; ++i)
        for (double t : switching.instants[i]) {
            const double speed = std::abs(evaluate_trig(ut.col(i), h, t).slope);
            if (speed == 0) continue;
            const double weight = m.contact.stiffness[i] * evaluate_trig(vt.col(i), h, t).value *
                                  evaluate_trig(wt.col(i), h, t).value / (2 * M_PI * speed);
            change(i, 0) += weight;
            for (std::int64_t k = 1; k <= h; ++k) {
                change(i, 2 * k - 1) += weight * std::cos(static_cast<double>(k) * t);
                change(i, 2 * k) += weight * std::sin(static_cast<double>(k) * t);
            }
        }
    gemv('T', -1.0, m.gap_0, change.col(0), 0.0, gradient.data());
    for (std::int64_t c = 0; c < columns; ++c)
        gemv('T', -1.0, m.gap, change.col(c + 1), 0.0, gradient.data() + m.static_size() + c * r);
    return gradient;
}

HarmonicFolds::HarmonicFolds(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                             const BranchPoint &about) {
    HbmOptions o = options;
    o.unknowns = NonlinearUnknowns::modal;
    o.aft = AftKind::event;
    o.n_harmonics = harmonics_of(about, o.period_multiple);
    inner_ = make_system(reduced, o);
    const double scale = size_of(*inner_, unknowns_of(*inner_, about));
    system_ = std::make_unique<FoldSystem>(*inner_, reduced, about, frequency_unit(scale, about.omega));
}

vector<double> HarmonicFolds::unknowns(const BranchPoint &point) const {
    return unknowns_of(*system_, point);
}

BranchPoint HarmonicFolds::solved_point(const PathState &at, double residual, std::int64_t iterations) {
    return plm::solved_point(*system_, at, residual, iterations);
}

} // namespace plm
