#include "orbits/orbit_folds.hpp"
#include "motions/response_at_force.hpp"
#include "orbits/orbit_point.hpp"

#include "linalg/dense.hpp"
#include "linalg/scale.hpp"
#include "orbits/orbit_points.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double beside = 1e-6; // of the motion: where the tangent is taken once more for its change
constexpr int inverse_steps = 4;

} // namespace

OrbitFoldSystem::OrbitFoldSystem(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                                 const BranchPoint &about)
    : by_frequency_(orbit_equations(std::move(reduced), options, about.omega, FlowParameter::frequency)),
      by_force_(orbit_equations(by_frequency_, options, about.omega, FlowParameter::force_scale)),
      n_(by_frequency_.size()), omega_(about.omega), weight_(*by_frequency_.weights()) {
    weight_.push_back(1);
    x_ = orbit_unknowns(by_frequency_, about, options.period_multiple);
    unit_ = frequency_unit(norm2(n_, x_.data()), omega_);
    by_frequency_.set_other(about.force_scale);
    choose_borders();
}

OrbitEquations &OrbitFoldSystem::at_force(double force) {
    by_frequency_.set_other(force);
    return by_frequency_;
}

vector<double> OrbitFoldSystem::unknowns(const BranchPoint &point, std::int64_t period_multiple) const {
    vector<double> y = orbit_unknowns(by_frequency_, point, period_multiple);
    y.push_back((point.omega - omega_) * unit_);
    return y;
}

// b and c near the left and right null vectors, by inverse iteration.
void OrbitFoldSystem::choose_borders() {
    vector<double> r(n_);
    by_frequency_.residual(x_.data(), omega_, r.data());
    by_frequency_.linearize();
    left_.assign(n_, 1.0);
    right_.assign(n_, 1.0);
    for (int k = 0; k < inverse_steps; ++k) {
        by_frequency_.solve_transposed(left_.data());
        by_frequency_.solve(right_.data(), 1);
        const double left = norm2(n_, left_.data()), right = norm2(n_, right_.data());
        for (std::int64_t i = 0; i < n_; ++i) left_[i] /= left, right_[i] /= right;
    }
}

void OrbitFoldSystem::residual(const double *y, double force, double *r) {
    x_.assign(y, y + n_);
    frequency_now_ = omega_of(y);
    force_now_ = force;
    by_frequency_.set_other(force);
    by_frequency_.residual(x_.data(), frequency_now_, r);
    failed_ = !std::isfinite(r[0]);
    r[n_] = NAN;
    if (failed_) return;
    by_frequency_.linearize();
    tangent_ = by_frequency_.tangent();
    find_null();
    r[n_] = null_[n_];
}

void OrbitFoldSystem::find_null() {
    Matrix m(n_ + 1, n_ + 1);
    for (std::int64_t j = 0; j < n_; ++j) {
        std::copy_n(tangent_.col(j), n_, m.col(j));
        m(n_, j) = right_[j];
        m(j, n_) = left_[j];
    }
    bordered_.factor(m);
    null_.assign(n_ + 1, 0.0);
    null_[n_] = 1;
    left_null_ = null_;
    bordered_.solve(null_.data(), 1, n_ + 1);
    bordered_.solve_transposed(left_null_.data(), 1, n_ + 1);
}

OrbitFoldSystem::Derivatives OrbitFoldSystem::derivatives_at(const vector<double> &x) {
    Derivatives d{vector<double>(n_), vector<double>(n_)};
    vector<double> r(n_);
    by_frequency_.residual(x.data(), frequency_now_, r.data());
    by_frequency_.parameter_derivative(d.by_frequency.data());
    by_force_.set_other(frequency_now_);
    by_force_.residual(x.data(), force_now_, r.data());
    by_force_.parameter_derivative(d.by_force.data());
    return d;
}

void OrbitFoldSystem::linearize() {
    Matrix a(n_ + 1, n_ + 1);
    by_force_now_.assign(n_ + 1, 0.0);
    if (failed_) {
        for (std::int64_t i = 0; i <= n_; ++i) a(i, i) = 1;
        lu_.factor(a);
        return;
    }
    const Derivatives here = derivatives_at(x_);
    const double step = beside * norm2(n_, x_.data()) / norm2(n_, null_.data());
    vector<double> x = x_;
    for (std::int64_t i = 0; i < n_; ++i) x[i] += step * null_[i];
    const Derivatives there = derivatives_at(x);
    by_frequency_.linearize();
    const Matrix tangent_there = by_frequency_.tangent();
    const auto change = [&](const double *from, const double *to) {
        return (dot(n_, left_null_.data(), from) - dot(n_, left_null_.data(), to)) / step;
    };
    for (std::int64_t j = 0; j < n_; ++j) {
        std::copy_n(tangent_.col(j), n_, a.col(j));
        a(n_, j) = change(tangent_.col(j), tangent_there.col(j));
        a(j, n_) = here.by_frequency[j] / unit_;
    }
    a(n_, n_) = change(here.by_frequency.data(), there.by_frequency.data()) / unit_;
    std::copy(here.by_force.begin(), here.by_force.end(), by_force_now_.begin());
    by_force_now_[n_] = change(here.by_force.data(), there.by_force.data());
    lu_.factor(a);
}

void OrbitFoldSystem::solve(double *b, std::int64_t n) {
    if (all_finite(b, n * size())) lu_.solve(b, n, size());
}

void OrbitFoldSystem::parameter_derivative(double *r) {
    std::copy(by_force_now_.begin(), by_force_now_.end(), r);
}

OrbitFolds::OrbitFolds(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                       const BranchPoint &about)
    : options_(options), system_(std::move(reduced), options, about) {}

vector<double> OrbitFolds::unknowns(const BranchPoint &point) const {
    return system_.unknowns(point, options_.period_multiple);
}

BranchPoint OrbitFolds::solved_point(const PathState &at, double residual, std::int64_t iterations) {
    const PathState state = {{at.x.begin(), at.x.end() - 1}, system_.omega_of(at.x.data())};
    return orbit_point(system_.at_force(at.parameter), options_, state, residual, iterations);
}

} // namespace plm
