#include "hbm/newton.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>

namespace plm {
namespace {

constexpr double fast_contraction = 0.2; // below: the old factorization is good enough for another step

class Newton {
  public:
    Newton(HbmSystem &system, const SideCondition &side, const NewtonLimits &limits, vector<double> &x,
           double &omega)
        : system_(system), side_(side), limits_(limits), x_(x), omega_(omega), n_(system.size()), r_(n_),
          step_(n_), border_(n_), trial_(n_), next_(n_) {}

    NewtonOutcome run() {
        if (limits_.factored)
            make_border(); // at the point the factorization belongs to, before residual() moves it
        system_.residual(x_.data(), omega_, r_.data());
        if (!limits_.factored) refactor();
        double size = correction(r_, step_, step_omega_);
        double damping = 1;
        while (out_.iterations < limits_.max_iterations) {
            ++out_.iterations;
            worked(1e5); // what the smallest system takes for an iteration, in time
            if (!std::isfinite(size)) return fail(PLM_REASON_SINGULAR_TANGENT);
            if (size <= allowed()) {
                apply(1.0, step_, step_omega_);
                return finish(size);
            }
            const double trial_omega = propose(damping);
            system_.residual(trial_.data(), trial_omega, r_.data());
            double next_omega = 0;
            const double next_size = correction(r_, next_, next_omega);
            const double contraction = next_size / size;
            if (std::isfinite(contraction) && contraction <= 1 - damping / 4) { // natural monotonicity
                x_ = trial_;
                omega_ = trial_omega;
                fresh_ = false;
                if (damping == 1 && contraction <= fast_contraction) {
                    step_.swap(next_);
                    step_omega_ = next_omega;
                    size = next_size;
                    continue;
                }
                refactor();
                size = correction(r_, step_, step_omega_);
                damping = std::min(1.0, damping * (contraction < 0.5 ? 4 : 1.5));
                continue;
            }
            if (!fresh_) { // the old factorization does not serve here: a new one before any damping
                system_.residual(x_.data(), omega_, r_.data());
                refactor();
                size = correction(r_, step_, step_omega_);
                continue;
            }
            damping = smaller_damping(damping, size, next_omega);
            if (damping < limits_.min_damping)
                return fail(seen_sets_repeat() ? PLM_REASON_CONTACT_CHATTER : PLM_REASON_STEP_MINIMUM);
        }
        return fail(seen_sets_repeat() ? PLM_REASON_CONTACT_CHATTER : PLM_REASON_STEP_MINIMUM);
    }

  private:
    void refactor() {
        system_.linearize();
        ++out_.factorizations;
        fresh_ = true;
        switching_.push_back(system_.indicator().n_switching);
        make_border();
    }

    // -(dR/dx)^-1 dR/domega at the point of the factorization; needed only when omega is free.
    void make_border() {
        if (!side_.x_weight) return;
        system_.omega_derivative(border_.data());
        for (double &b : border_) b = -b;
        system_.solve(border_.data(), 1);
    }

    // Newton correction for residual r with the present factorization; returns its size. r is kept.
    double correction(const vector<double> &r, vector<double> &step, double &step_omega) {
        for (std::int64_t i = 0; i < n_; ++i) step[i] = -r[i];
        system_.solve(step.data(), 1);
        step_omega = 0;
        if (side_.x_weight) {
            const double along = dot(n_, side_.x_weight->data(), step.data());
            const double slope = dot(n_, side_.x_weight->data(), border_.data()) + side_.omega_weight;
            step_omega = -along / slope;
            for (std::int64_t i = 0; i < n_; ++i) step[i] += step_omega * border_[i];
        }
        return std::hypot(norm2(n_, step.data()) / scale(), step_omega / limits_.omega_scale);
    }

    // The dynamic part of x: what the answer's accuracy refers to.
    double scale() const {
        const std::int64_t s = system_.static_size();
        const double dynamic = norm2(n_ - s, x_.data() + s);
        if (dynamic > 0) return dynamic;
        const double all = norm2(n_, x_.data());
        return all > 0 ? all : 1;
    }

    // Rounding of the static part bounds what can be reached.
    double allowed() const { return limits_.tolerance + 1e-14 * norm2(n_, x_.data()) / scale(); }

    double propose(double damping) {
        for (std::int64_t i = 0; i < n_; ++i) trial_[i] = x_[i] + damping * step_[i];
        return omega_ + damping * step_omega_;
    }

    void apply(double factor, const vector<double> &step, double step_omega) {
        for (std::int64_t i = 0; i < n_; ++i) x_[i] += factor * step[i];
        omega_ += factor * step_omega;
    }

    // Deuflhard's estimate of the damping that the local curvature allows.
    double smaller_damping(double damping, double size, double next_omega) {
        for (std::int64_t i = 0; i < n_; ++i) next_[i] -= (1 - damping) * step_[i];
        const double change = std::hypot(norm2(n_, next_.data()) / scale(),
                                         (next_omega - (1 - damping) * step_omega_) / limits_.omega_scale);
        const double estimate = change > 0 ? 0.5 * damping * damping * size / change : 0.0;
        return std::min(0.5 * damping, std::max(estimate, 0.1 * damping));
    }

    // The number of moving pairs goes to and fro: Newton cycles between contact sets.
    bool seen_sets_repeat() const {
        if (switching_.size() < 6) return false;
        const auto last = switching_.end();
        return *(last - 1) == *(last - 3) && *(last - 2) == *(last - 4) && *(last - 1) != *(last - 2);
    }

    NewtonOutcome finish(double size) {
        system_.residual(x_.data(), omega_, r_.data());
        const double scale = system_.residual_scale();
        out_.residual = scale > 0 ? norm2(n_, r_.data()) / scale : norm2(n_, r_.data());
        out_.converged = std::isfinite(out_.residual) && system_.in_balance();
        out_.factored_here = fresh_ && size < 1e-6;
        return out_;
    }

    NewtonOutcome fail(std::int32_t reason) {
        out_.reason = reason;
        return out_;
    }

    HbmSystem &system_;
    const SideCondition &side_;
    const NewtonLimits &limits_;
    vector<double> &x_;
    double &omega_;
    std::int64_t n_;
    vector<double> r_, step_, border_, trial_, next_;
    double step_omega_ = 0;
    bool fresh_ = false; // the factorization belongs to x_
    vector<std::int64_t> switching_;
    NewtonOutcome out_;
};

} // namespace

NewtonOutcome newton(HbmSystem &system, const SideCondition &side, const NewtonLimits &limits,
                     vector<double> &x, double &omega) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    NewtonOutcome out = Newton(system, side, limits, x, omega).run();
    out.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return out;
}

} // namespace plm
