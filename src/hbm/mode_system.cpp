#include "hbm/mode_system.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

NonlinearModeSystem::NonlinearModeSystem(HbmSystem &inner, const ReducedModel &m, vector<double> shape,
                                         double omega_reference, double largest_amplitude)
    : WrappedSystem(inner), r_(m.size()), n_with_mass_(m.size() - m.n_massless), shape_(std::move(shape)),
      omega_reference_(omega_reference), largest_(largest_amplitude), y_(inner.size() + 2), x_(inner.size()) {
    for (std::int64_t j = 0; j < r_; ++j) shape_[j] *= m.mass(j);
}

void NonlinearModeSystem::unscale(const double *y, double amplitude, double *x) const {
    for (std::int64_t i = 0; i < inner_.size(); ++i) x[i] = (i < static_size() ? largest_ : amplitude) * y[i];
}

// r += -2 xi omega M q' with factor = 2 xi omega^2.
void NonlinearModeSystem::add_self_excitation(const double *x, double factor, double *r) const {
    const std::int64_t s = static_size(), harmonics = (inner_.size() - s) / (2 * r_);
    for (std::int64_t h = 1; h <= harmonics; ++h) {
        const std::int64_t a = s + 2 * (h - 1) * r_, b = a + r_;
        for (std::int64_t j = 0; j < n_with_mass_; ++j) {
            r[a + j] -= factor * static_cast<double>(h) * x[b + j];
            r[b + j] += factor * static_cast<double>(h) * x[a + j];
        }
    }
}

void NonlinearModeSystem::residual(const double *y, double log_amplitude, double *r) {
    const std::int64_t n = inner_.size(), s = static_size();
    y_.assign(y, y + n + 2);
    amplitude_ = std::exp(log_amplitude);
    unscale(y, amplitude_, x_.data());
    inner_.set_force_scale(0);
    inner_.set_self_excitation(y[n + 1]);
    inner_.residual(x_.data(), omega(), r);
    for (std::int64_t i = 0; i < n; ++i) r[i] /= i < s ? largest_ : amplitude_;
    const double scale = omega_reference_ * omega_reference_; // like the other equations
    r[n] = scale * dot(r_, shape_.data(), y + s + r_);
    r[n + 1] = scale * (dot(r_, shape_.data(), y + s) - 1);
}

double NonlinearModeSystem::residual_scale() const {
    return omega_reference_ * omega_reference_;
}

// The equations of the unknowns not scaled; solve() scales.
void NonlinearModeSystem::linearize() {
    const std::int64_t n = inner_.size(), s = static_size();
    border_.reset(n, 2);
    double *by_omega = border_.columns.col(0);
    inner_.parameter_derivative(by_omega);
    for (std::int64_t i = 0; i < n; ++i) by_omega[i] *= omega_reference_;
    add_self_excitation(x_.data(), 2 * omega() * omega(), border_.columns.col(1));
    const double scale = omega_reference_ * omega_reference_ / amplitude_;
    for (std::int64_t j = 0; j < r_; ++j) {
        border_.rows(s + r_ + j, 0) = scale * shape_[j];
        border_.rows(s + j, 1) = scale * shape_[j];
    }
    factored_amplitude_ = amplitude_;
    inner_.factor_bordered(border_, factor_);
}

void NonlinearModeSystem::solve(double *b, std::int64_t columns) {
    const std::int64_t n = inner_.size(), s = static_size();
    for (std::int64_t k = 0; k < columns; ++k)
        for (std::int64_t i = 0; i < n; ++i) b[i + k * size()] *= i < s ? largest_ : factored_amplitude_;
    factor_.solve(b, columns);
    for (std::int64_t k = 0; k < columns; ++k)
        for (std::int64_t i = 0; i < n; ++i) b[i + k * size()] /= i < s ? largest_ : factored_amplitude_;
}

// At a solution: the unknowns scaled by the amplitude change with it, x' = x_dynamic.
void NonlinearModeSystem::parameter_derivative(double *r) {
    const std::int64_t n = inner_.size(), s = static_size();
    vector<double> x(x_);
    std::fill(x.begin(), x.begin() + s, 0.0);
    inner_.jacobian_product(x.data(), r);
    for (std::int64_t i = 0; i < n; ++i) r[i] /= i < s ? largest_ : amplitude_;
    r[n] = r[n + 1] = 0; // the normalisation is that of the scaled unknowns
}

void NonlinearModeSystem::to_point(const double *y, double log_amplitude, BranchPoint &point) {
    vector<double> x(inner_.size());
    unscale(y, std::exp(log_amplitude), x.data());
    inner_.to_point(x.data(), omega_reference_ * (1 + y[inner_.size()]), point);
    point.force_scale = 0;
    point.damping_ratio = y[inner_.size() + 1];
}

void NonlinearModeSystem::from_point(const BranchPoint &point, double *y) {
    const std::int64_t n = inner_.size(), s = static_size();
    inner_.from_point(point, y);
    const double amplitude = dot(r_, shape_.data(), y + s);
    for (std::int64_t i = 0; i < n; ++i) y[i] /= i < s ? largest_ : amplitude;
    y[n] = point.omega / omega_reference_ - 1;
    y[n + 1] = point.damping_ratio;
}

} // namespace plm
