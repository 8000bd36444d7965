#include "orbits/stationary_force.hpp"
#include "motions/response_at_force.hpp"
#include "orbits/orbit_point.hpp"

#include "linalg/dense.hpp"
#include "linalg/lapack.hpp"
#include "linalg/scale.hpp"
#include "orbits/orbit_points.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace plm {
namespace {

constexpr int most_corrections = 12, most_steps = 12;
// Of the motion: the last correction of a motion, what its derivatives are good to; a farther one is no
// correction.
constexpr double corrected = 1e-5, far_off = 0.5;
// Of the motion: places where the slopes are taken once more for their change, which is told to a hundredth
// by motions that are corrected so well; and the longest step.
constexpr double shift = 1e-3, longest = 0.1;
constexpr double exact_enough = 1e-6; // of the force: by which another step would still change it

using Pair = std::array<double, 2>;

/// A motion for each frequency and amplitude (along a fixed direction, near the tangent's null vector), by
/// the force that it takes: there are no folds.
class ForceSurface {
  public:
    struct Place {
        Pair at = {}; // frequency and amplitude, from the first motion, in its size
        vector<double> x;
        double force = 0;
        Matrix rates; // of both, (n + 1) x 2, by frequency and by amplitude
        /// Of the force.
        Pair slope() const { return {rates(rates.rows() - 1, 0), rates(rates.rows() - 1, 1)}; }
    };

    ForceSurface(const std::shared_ptr<const ReducedModel> &reduced, const MotionOptions &options,
                 const BranchPoint &near, Watch watch)
        : watch_(watch), by_force_(orbit_equations(reduced, options, near.omega, FlowParameter::force_scale)),
          by_frequency_(orbit_equations(by_force_, options, near.omega, FlowParameter::frequency)),
          n_(by_force_.size()), omega_(near.omega) {
        first_.x = orbit_unknowns(by_force_, near, options.period_multiple);
        first_.force = near.force_scale;
        size_ = norm2(n_, first_.x.data());
        unit_ = frequency_unit(1, omega_);
    }

    /// False: there is no motion near the point.
    bool begin(Place &place) {
        if (!(size_ > 0 && std::isfinite(size_)) || !run(first_.x, first_.force, omega_)) return false;
        along_ = null_direction(by_force_);
        place = first_;
        return correct(place);
    }

    bool move(const Pair &to, Place &place) {
        for (int k : {0, 1}) {
            const double more = to[k] - place.at[k];
            for (std::int64_t i = 0; i < n_; ++i) place.x[i] += more * place.rates(i, k);
            place.force += more * place.rates(n_, k);
        }
        place.at = to;
        return correct(place);
    }

  private:
    double omega_at(const Place &p) const { return omega_ + p.at[0] / unit_; }

    bool run(const vector<double> &x, double force, double omega) {
        residual_.assign(n_ + 1, 0.0);
        by_force_.set_other(omega);
        by_force_.residual(x.data(), force, residual_.data());
        if (!all_finite(residual_.data(), n_)) return false;
        by_force_.linearize();
        return true;
    }

    // [dR/dx dR/dforce; along 0]
    void factor() {
        const Matrix tangent = by_force_.tangent();
        Matrix a(n_ + 1, n_ + 1);
        for (std::int64_t j = 0; j < n_; ++j) {
            std::copy_n(tangent.col(j), n_, a.col(j));
            a(n_, j) = along_[j];
        }
        by_force_.parameter_derivative(a.col(n_));
        // one force moves the motion by its size
        force_unit_ = norm2(n_, a.col(n_));
        if (force_unit_ > 0)
            for (std::int64_t i = 0; i < n_; ++i) a(i, n_) /= force_unit_;
        lu_.factor(a);
    }

    bool correct(Place &p) {
        for (int k = 0; k < most_corrections; ++k) {
            watch_.step("isolated branches", 1);
            if (!run(p.x, p.force, omega_at(p))) return false;
            factor();
            vector<double> &c = residual_;
            for (std::int64_t i = 0; i < n_; ++i) c[n_] += along_[i] * (p.x[i] - first_.x[i]);
            c[n_] -= p.at[1] * size_;
            lu_.solve(c.data(), 1, n_ + 1);
            const double moved = norm2(n_, c.data());
            if (!(moved < far_off * size_) || !(force_unit_ > 0)) return false;
            for (std::int64_t i = 0; i < n_; ++i) p.x[i] -= c[i];
            p.force -= c[n_] / force_unit_;
            if (moved <= corrected * size_) {
                find_rates(p);
                return all_finite(p.rates.data(), 2 * (n_ + 1));
            }
        }
        return false;
    }

    // By the matrix of the last correction.
    void find_rates(Place &p) {
        Matrix &b = p.rates = Matrix(n_ + 1, 2);
        by_frequency_.set_other(p.force);
        by_frequency_.residual(p.x.data(), omega_at(p), b.col(1));
        by_frequency_.parameter_derivative(b.col(0));
        for (std::int64_t i = 0; i < n_; ++i) b(i, 0) /= -unit_, b(i, 1) = 0;
        b(n_, 0) = 0;
        b(n_, 1) = size_;
        lu_.solve(b.data(), 2, n_ + 1);
        for (int k : {0, 1}) b(n_, k) /= force_unit_;
    }

    Watch watch_;
    OrbitEquations by_force_, by_frequency_;
    std::int64_t n_;
    double omega_, size_ = 0, unit_ = 0, force_unit_ = 0;
    Place first_;
    vector<double> along_, residual_;
    RealLu lu_;
};

/// Second derivatives of the force, symmetric.
struct Curvature {
    double a = 0, b = 0, c = 0; // [a b; b c]

    double determinant() const { return a * c - b * b; }
    bool is(ForceExtremum kind) const {
        return kind == ForceExtremum::saddle ? determinant() < 0 : determinant() > 0 && a > 0;
    }
    /// To where the slope vanishes.
    Pair step(const Pair &slope) const {
        const double d = determinant();
        return {(b * slope[1] - c * slope[0]) / d, (b * slope[0] - a * slope[1]) / d};
    }
};

bool curvature_at(ForceSurface &surface, const ForceSurface::Place &here, Curvature &found) {
    Pair change[2];
    for (int k : {0, 1}) {
        ForceSurface::Place there = here;
        Pair to = here.at;
        to[k] += shift;
        if (!surface.move(to, there)) return false;
        for (int i : {0, 1}) change[k][i] = (there.slope()[i] - here.slope()[i]) / shift;
    }
    found = {change[0][0], 0.5 * (change[0][1] + change[1][0]), change[1][1]};
    return found.determinant() != 0;
}

} // namespace

double stationary_force(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                        const BranchPoint &near, ForceExtremum kind, Watch watch) {
    ForceSurface surface(reduced, options, near, watch);
    ForceSurface::Place here;
    if (!surface.begin(here)) return NAN;
    for (int k = 0; k < most_steps; ++k) {
        Curvature curvature;
        if (!curvature_at(surface, here, curvature)) return NAN;
        const Pair slope = here.slope(), step = curvature.step(slope);
        const double length = std::hypot(step[0], step[1]),
                     gain = 0.5 * (slope[0] * step[0] + slope[1] * step[1]);
        if (length <= longest && std::abs(gain) <= exact_enough * std::abs(here.force))
            return curvature.is(kind) ? here.force + gain : NAN;
        const double part = std::min(1.0, longest / length);
        if (!surface.move({here.at[0] + part * step[0], here.at[1] + part * step[1]}, here)) return NAN;
    }
    return NAN;
}

} // namespace plm
