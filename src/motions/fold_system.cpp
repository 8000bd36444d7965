#include "motions/fold_system.hpp"
#include "motions/response_at_force.hpp"

namespace plm {

FoldSystem::FoldSystem(PeriodicEquations &inner, const BranchPoint &about)
    : FreeFrequency(inner, about.omega, frequency_unit(size_of(inner, inner.unknowns(about)), about.omega)) {
    choose_borders(about);
}

// b and c near the left and right null vectors, by inverse iteration.
void FoldSystem::choose_borders(const BranchPoint &about) {
    constexpr int inverse_steps = 4;
    const vector<double> x = inner_.unknowns(about);
    vector<double> r(x.size());
    inner_.set(PathParameter::force, about.force_scale);
    inner_.residual(x.data(), about.omega, r.data());
    inner_.factor_bordered(Border(), linear_);
    border_.reset(n_, 1);
    double *b = border_.columns.data(), *c = border_.rows.data();
    std::fill(b, b + n_, 1.0);
    std::fill(c, c + n_, 1.0);
    for (int k = 0; k < inverse_steps; ++k) {
        linear_->solve_transposed(b, 1);
        linear_->solve(c, 1);
        const double left = norm2(n_, b), right = norm2(n_, c);
        for (std::int64_t i = 0; i < n_; ++i) b[i] /= left, c[i] /= right;
    }
    for (std::int64_t i = 0; i < n_; ++i) b[i] *= inner_.row_size(about.omega);
}

double FoldSystem::last_equation() {
    inner_.factor_bordered(border_, bordered_);
    v_.assign(n_ + 1, 0.0);
    v_[n_] = 1;
    bordered_->solve(v_.data(), 1);
    return v_[n_];
}

bool FoldSystem::linearize_all(double &by_force) {
    std::swap(linear_, bordered_);
    null_ = v_;
    vector<double> w(n_ + 1, 0.0);
    w[n_] = 1;
    linear_->solve_transposed(w.data(), 1);
    frequency_.assign(n_ + 1, 0.0);
    inner_.parameter_derivative(frequency_.data());
    for (std::int64_t i = 0; i < n_; ++i) frequency_[i] /= -unit_;
    linear_->solve(frequency_.data(), 1);
    const MotionGradient change = inner_.tangent_change(w, v_);
    by_force = change.by_force;
    gradient_ = change.by_unknowns;
    gradient_.push_back(change.by_frequency / unit_);
    determinant_ = null_[n_] * (dot(n_, gradient_.data(), frequency_.data()) + gradient_[n_]) -
                   frequency_[n_] * dot(n_, gradient_.data(), null_.data());
    return true;
}

// x = a + beta v + s z with (a, alpha) = M^-1 (r, 0): J x + s dR/dy_omega = r asks for
// alpha + beta g + s zeta = 0, the last equation for dg/dy . (x, s) = r_last.
void FoldSystem::solve_linear(double *b, std::int64_t columns) {
    const double gv = dot(n_, gradient_.data(), null_.data()),
                 gz = dot(n_, gradient_.data(), frequency_.data()) + gradient_[n_];
    for (std::int64_t k = 0; k < columns; ++k) {
        double *x = b + k * (n_ + 1);
        const double last = x[n_];
        x[n_] = 0;
        linear_->solve(x, 1);
        const double first = -x[n_], second = last - dot(n_, gradient_.data(), x);
        const double beta = (first * gz - frequency_[n_] * second) / determinant_,
                     s = (null_[n_] * second - gv * first) / determinant_;
        for (std::int64_t i = 0; i < n_; ++i) x[i] += beta * null_[i] + s * frequency_[i];
        x[n_] = s;
    }
}

int FoldSystem::determinant_sign() const {
    return determinant_ < 0 ? -linear_->determinant_sign() : linear_->determinant_sign();
}

} // namespace plm
