#include "orbits/exact_equations.hpp"
#include "linalg/lapack.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/orbit_points.hpp"
#include "orbits/orbit_work.hpp"
#include "structure/driven_harmonic.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double beside = 1e-6;  // of the motion: where the tangent is taken once more for its change
constexpr double told_by = 1e-6; // relative: where the work is taken once more for its change

class DenseTangent final : public BorderedTangent {
  public:
    void factor(const Matrix &tangent, const Border &border) {
        const std::int64_t n = tangent.rows(), k = border.corner.rows();
        Matrix a(n + k, n + k);
        for (std::int64_t j = 0; j < n; ++j) {
            std::copy_n(tangent.col(j), n, a.col(j));
            for (std::int64_t i = 0; i < k; ++i) a(n + i, j) = border.rows(j, i);
        }
        for (std::int64_t j = 0; j < k; ++j) {
            std::copy_n(border.columns.col(j), n, a.col(n + j));
            for (std::int64_t i = 0; i < k; ++i) a(n + i, n + j) = border.corner(i, j);
        }
        size_ = n + k;
        lu_.factor(a);
    }
    void solve(double *b, std::int64_t n) override { lu_.solve(b, n, size_); }
    void solve_transposed(double *b, std::int64_t n) override { lu_.solve_transposed(b, n, size_); }
    int determinant_sign() const override { return lu_.determinant_sign(); }

  private:
    std::int64_t size_ = 0;
    RealLu lu_;
};

} // namespace

ExactEquations::ExactEquations(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                               double omega, const BranchPoint *known)
    : options_(options),
      orbits_(orbit_equations(std::move(reduced), options, omega, FlowParameter::frequency, known)),
      by_force_(orbit_equations(orbits_, options, omega, FlowParameter::force_scale)), omega_(omega) {
    harmonic_ = driven_harmonic(orbits_.model().excitation());
    if (harmonic_ == 0) return;
    // a load of this size on a displacement, as an energy
    const HarmonicLoad f = load(omega);
    const double force = std::hypot(norm2(static_cast<std::int64_t>(f.real.size()), f.real.data()),
                                    norm2(static_cast<std::int64_t>(f.imag.size()), f.imag.data()));
    phase_size_ = force > 0 ? omega / force : 1;
}

void ExactEquations::residual(const double *x, double omega, double *r) {
    x_.assign(x, x + size());
    omega_ = omega;
    orbits_.residual(x, omega, r);
}

void ExactEquations::set(PathParameter parameter, double value) {
    if (parameter != PathParameter::force)
        throw Error(status::argument,
                    "exact motions are not followed over the contact stiffness; set motion to harmonics")
            .argument("motion");
    options_.force_scale = value;
    orbits_.set_other(value);
}

void ExactEquations::derivative(PathParameter, double *r) {
    by_force_.set_other(omega_);
    by_force_.residual(x_.data(), options_.force_scale, r);
    by_force_.parameter_derivative(r);
}

vector<double> ExactEquations::unknowns(const BranchPoint &point) const {
    return orbit_unknowns(orbits_, point, options_.period_multiple);
}

BranchPoint ExactEquations::solved_point(const PathState &at, double residual, std::int64_t iterations) {
    return orbit_point(orbits_, options_, at, residual, iterations);
}

bool ExactEquations::find(double omega, Watch watch, vector<double> &x, NewtonWork &work) {
    NewtonOutcome out;
    const bool found = march_to_orbit(orbits_, options_, omega, 0, watch, x, out);
    work += out;
    return found;
}

void ExactEquations::factor_bordered(const Border &border, std::unique_ptr<BorderedTangent> &out) {
    orbits_.linearize();
    if (!out) out = std::make_unique<DenseTangent>();
    static_cast<DenseTangent &>(*out).factor(orbits_.tangent(), border);
}

ExactEquations::Derivatives ExactEquations::derivatives() {
    Derivatives d{orbits_.tangent(), vector<double>(x_.size()), vector<double>(x_.size())};
    orbits_.parameter_derivative(d.by_frequency.data());
    derivative(PathParameter::force, d.by_force.data());
    return d;
}

MotionGradient ExactEquations::tangent_change(const vector<double> &w, const vector<double> &v) {
    const std::int64_t n = size();
    const Derivatives here = derivatives();
    const double step = beside * norm2(n, x_.data()) / norm2(n, v.data());
    vector<double> x = x_, r(x_.size());
    for (std::int64_t i = 0; i < n; ++i) x[i] += step * v[i];
    residual(x.data(), omega_, r.data());
    orbits_.linearize();
    const Derivatives there = derivatives();
    const auto change = [&](const double *from, const double *to) {
        return (dot(n, w.data(), from) - dot(n, w.data(), to)) / step;
    };
    MotionGradient gradient{vector<double>(x.size()),
                            change(here.by_frequency.data(), there.by_frequency.data()),
                            change(here.by_force.data(), there.by_force.data())};
    for (std::int64_t j = 0; j < n; ++j)
        gradient.by_unknowns[j] = change(here.by_unknowns.col(j), there.by_unknowns.col(j));
    return gradient;
}

// By the contact of the motion of the last residual(), whose last interval ends with the period.
double ExactEquations::work(double omega, double force) const {
    if (harmonic_ == 0) return 0;
    std::vector<ContactInterval> intervals = orbits_.intervals();
    const double period = 2 * M_PI / omega * static_cast<double>(options_.period_multiple);
    double rest = period;
    for (const ContactInterval &interval : intervals) rest -= interval.duration;
    if (!intervals.empty()) intervals.back().duration += rest;
    return orbit_work(orbits_.model(), orbits_.state(x_.data()), omega, force, intervals, load(omega),
                      harmonic_ * omega, *orbits_.modes()) /
           period;
}

double ExactEquations::phase() {
    return phase_size_ * (work_ = work(omega_, options_.force_scale));
}

// None where a set has no modes of its own. By the force the work is linear as long as the events stay.
bool ExactEquations::phase_gradient(MotionGradient &gradient) {
    gradient = {vector<double>(x_.size()), 0, 0};
    if (harmonic_ == 0) return true;
    gradient.by_unknowns = work_gradient(orbits_.model(), orbits_.intervals(), load(omega_),
                                         harmonic_ * omega_, *orbits_.modes());
    if (gradient.by_unknowns.empty()) return false;
    orbits_.to_unknowns(gradient.by_unknowns);
    const double period = 2 * M_PI / omega_ * static_cast<double>(options_.period_multiple),
                 force = options_.force_scale, d_omega = told_by * omega_;
    for (double &d : gradient.by_unknowns) d *= phase_size_ / period;
    gradient.by_frequency = phase_size_ * (work(omega_ + d_omega, force) - work_) / d_omega;
    gradient.by_force = phase_size_ * (work(omega_, 2 * force) - work_) / force;
    return true;
}

} // namespace plm
