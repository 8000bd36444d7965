#include "motions/free_frequency.hpp"
#include "linalg/scale.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

FreeFrequency::FreeFrequency(PeriodicEquations &inner, double omega_reference, double unit,
                             PathParameter parameter)
    : inner_(inner), n_(inner.size()), unit_(unit), reference_(omega_reference), parameter_(parameter) {
    if (!inner.weights()) return;
    weights_ = *inner.weights();
    weights_.push_back(1);
}

void FreeFrequency::residual(const double *y, double p, double *r) {
    x_.assign(y, y + n_);
    omega_ = omega_of(y);
    stands_ = true;
    std::fill(r, r + n_ + 1, NAN);
    failed_ = !(omega_ > 0);
    if (failed_) return;
    inner_.set(parameter_, p);
    inner_.residual(x_.data(), omega_, r);
    failed_ = !std::isfinite(r[0]);
    if (!failed_) r[n_] = last_equation();
}

void FreeFrequency::linearize() {
    by_force_.assign(n_ + 1, 0.0);
    if (failed_) return;
    if (!stands_) { // linearised here before, which has moved the equations
        vector<double> r(x_.size());
        inner_.residual(x_.data(), omega_, r.data());
        last_equation();
    }
    stands_ = false;
    inner_.derivative(parameter_, by_force_.data());
    failed_ = !linearize_all(by_force_[n_]);
    if (parameter_ != PathParameter::force) by_force_[n_] = 0; // phase knows the motion and the force alone
}

void FreeFrequency::solve(double *b, std::int64_t n) {
    if (failed_) std::fill_n(b, n * size(), NAN);
    if (all_finite(b, n * size())) solve_linear(b, n);
}

void FreeFrequency::parameter_derivative(double *r) {
    std::copy(by_force_.begin(), by_force_.end(), r);
}

vector<double> FreeFrequency::unknowns(const BranchPoint &point) const {
    vector<double> y = inner_.unknowns(point);
    y.push_back((point.omega - reference_) * unit_);
    return y;
}

BranchPoint FreeFrequency::solved_point(const PathState &at, double residual, std::int64_t iterations) {
    inner_.set(parameter_, at.parameter);
    return inner_.solved_point({{at.x.begin(), at.x.end() - 1}, omega_of(at.x.data())}, residual, iterations);
}

} // namespace plm
