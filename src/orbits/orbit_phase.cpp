#include "orbits/orbit_phase.hpp"
#include "linalg/dense.hpp"
#include "linalg/lapack.hpp"
#include "linalg/scale.hpp"
#include "motions/response_at_force.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/orbit_points.hpp"
#include "orbits/recorded_motion.hpp"
#include "orbits/work_gradient.hpp"
#include "structure/driven_harmonic.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double told_by = 1e-6; // relative: where the work is taken once more for its change

} // namespace

OrbitPhaseSystem::OrbitPhaseSystem(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                                   const BranchPoint &about)
    : by_frequency_(orbit_equations(std::move(reduced), options, about.omega, FlowParameter::frequency)),
      by_force_(orbit_equations(by_frequency_, options, about.omega, FlowParameter::force_scale)),
      n_(by_frequency_.size()), period_multiple_(options.period_multiple), omega_(about.omega),
      weight_(*by_frequency_.weights()) {
    weight_.push_back(1);
    if (const auto *driven = driven_harmonic(by_frequency_.model().excitation())) {
        harmonic_ = driven->first;
        load_ = &driven->second;
    }
    take_unit(options, about);
}

void OrbitPhaseSystem::take_unit(const MotionOptions &options, const BranchPoint &about) {
    x_ = orbit_unknowns(by_frequency_, about, period_multiple_);
    scale_ = response_at_force(norm2(n_, x_.data()), about, options);
    unit_ = scale_ / (2 * M_PI * (options.frequency_max_hz - options.frequency_min_hz));
    if (!load_) return;
    // like the other equations: a load of this size on a displacement, as an energy
    const double force = std::hypot(norm2(static_cast<std::int64_t>(load_->real.size()), load_->real.data()),
                                    norm2(static_cast<std::int64_t>(load_->imag.size()), load_->imag.data()));
    row_scale_ = force > 0 ? omega_ / force : 1;
}

vector<double> OrbitPhaseSystem::unknowns(const BranchPoint &point) const {
    vector<double> y = orbit_unknowns(by_frequency_, point, period_multiple_);
    y.push_back((point.omega - omega_) * unit_);
    return y;
}

OrbitEquations &OrbitPhaseSystem::at_force(double force) {
    by_frequency_.set_other(force);
    return by_frequency_;
}

// Mean over the period of load(t) . y.
double OrbitPhaseSystem::work(double omega, double force) const {
    if (!load_) return 0;
    OrbitConditions at = by_frequency_.conditions(omega);
    at.force_scale = force;
    RecordedMotion motion;
    ExactFlow flow = at.flow(by_frequency_.shared_model(), by_frequency_.modes());
    FlowState state = by_frequency_.state(x_.data());
    flow.complete(state);
    flow.advance(state, static_cast<double>(period_multiple_) * flow.period(), &motion);
    const Matrix q = motion.harmonics(harmonic_ * period_multiple_, 1);
    double sum = 0;
    for (std::int64_t j = 0; j < q.rows(); ++j) {
        sum += load_->real[j] * q(j, 0);
        if (!load_->imag.empty()) sum -= load_->imag[j] * q(j, 1);
    }
    return 0.5 * sum;
}

void OrbitPhaseSystem::residual(const double *y, double force, double *r) {
    x_.assign(y, y + n_);
    frequency_now_ = omega_of(y);
    force_now_ = force;
    failed_ = !(frequency_now_ > 0);
    std::fill(r, r + n_ + 1, NAN);
    if (failed_) return;
    at_force(force).residual(x_.data(), frequency_now_, r);
    failed_ = !std::isfinite(r[0]);
    if (failed_) return;
    work_ = work(frequency_now_, force);
    r[n_] = row_scale_ * work_;
}

void OrbitPhaseSystem::linearize() {
    Matrix a(n_ + 1, n_ + 1);
    by_force_now_.assign(n_ + 1, 0.0);
    vector<double> row;
    if (!failed_) {
        by_frequency_.linearize();
        row = load_ ? work_gradient(by_frequency_.model(), by_frequency_.intervals(), *load_,
                                    harmonic_ * frequency_now_, *by_frequency_.modes())
                    : vector<double>(n_, 0.0);
    }
    if (row.empty()) { // no motion, or a set without modes of its own: nothing to correct by
        failed_ = true;
        for (std::int64_t i = 0; i <= n_; ++i) a(i, i) = 1;
        lu_.factor(a);
        return;
    }
    by_frequency_.to_unknowns(row);
    const Matrix tangent = by_frequency_.tangent();
    const double period = 2 * M_PI / frequency_now_ * static_cast<double>(period_multiple_);
    for (std::int64_t j = 0; j < n_; ++j) {
        std::copy_n(tangent.col(j), n_, a.col(j));
        a(n_, j) = row_scale_ / period * row[j];
    }
    by_frequency_.parameter_derivative(a.col(n_));
    const double d_omega = told_by * frequency_now_, d_force = told_by * force_now_;
    a(n_, n_) = row_scale_ * (work(frequency_now_ + d_omega, force_now_) - work_) / d_omega;
    for (std::int64_t i = 0; i <= n_; ++i) a(i, n_) /= unit_;
    lu_.factor(a);
    vector<double> r(n_);
    by_force_.set_other(frequency_now_);
    by_force_.residual(x_.data(), force_now_, r.data());
    by_force_.parameter_derivative(by_force_now_.data());
    by_force_now_[n_] = row_scale_ * (work(frequency_now_, force_now_ + d_force) - work_) / d_force;
}

void OrbitPhaseSystem::solve(double *b, std::int64_t n) {
    if (failed_) std::fill_n(b, n * size(), NAN);
    if (all_finite(b, n * size())) lu_.solve(b, n, size());
}

void OrbitPhaseSystem::parameter_derivative(double *r) {
    std::copy(by_force_now_.begin(), by_force_now_.end(), r);
}

BranchPoint OrbitPhase::solved_point(const PathState &at, double residual, std::int64_t iterations) {
    const PathState state = {{at.x.begin(), at.x.end() - 1}, system_.omega_of(at.x.data())};
    return orbit_point(system_.at_force(at.parameter), options_, state, residual, iterations);
}

vector<std::complex<double>> OrbitPhase::multipliers(const BranchPoint &point) {
    if (options_.stability == StabilityKind::off) return {};
    OrbitEquations &equations = system_.at_force(point.force_scale);
    const vector<double> x = orbit_unknowns(equations, point, options_.period_multiple);
    vector<double> r(x.size());
    equations.residual(x.data(), point.omega, r.data());
    equations.linearize();
    return equations.multipliers();
}

} // namespace plm
