#include "hbm/continuation.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

struct State {
    vector<double> x;
    double omega = 0;
};

class Continuation {
  public:
    Continuation(HbmSystem &system, const PathOptions &options, PathOwner &owner)
        : system_(system), options_(options), owner_(owner), n_(system.size()), low_(options.low),
          high_(options.high), width_(high_ - low_), scratch_(n_) {}

    PathOutcome run(const vector<double> &x, double omega, double residual) {
        now_ = {x, omega};
        first_ = now_;
        grow_scale();
        record(residual, 0);
        linearize_here();
        make_tangent(nullptr);
        double step = options_.initial_step > 0 ? options_.initial_step : 0.2 * options_.max_step;
        while (out_.end_reason == PLM_REASON_NONE) {
            if (n_recorded_ >= options_.max_points) {
                end(PLM_REASON_POINT_LIMIT);
            } else if (owner_.cancelled(progress())) {
                end(PLM_REASON_CANCELLED);
            } else {
                advance(step);
            }
        }
        out_.x = now_.x;
        out_.parameter = now_.omega;
        return out_;
    }

  private:
    void end(std::int32_t reason) { out_.end_reason = reason; }

    void linearize_here() {
        system_.residual(now_.x.data(), now_.omega, scratch_.data());
        system_.linearize();
        ++out_.factorizations;
        factored_ = true;
    }

    double progress() const {
        const double done = (options_.upward ? now_.omega - low_ : high_ - now_.omega) / width_;
        return std::min(1.0, std::max(0.0, done));
    }

    double dynamic_norm(const vector<double> &x) const {
        const std::int64_t s = system_.static_size();
        return norm2(n_ - s, x.data() + s);
    }

    // The metric follows the largest response met, so that the flanks cost few points.
    void grow_scale() {
        scale_ = std::max(scale_, dynamic_norm(now_.x));
        if (scale_ == 0) scale_ = norm2(n_, now_.x.data());
        if (scale_ == 0) scale_ = 1; // nothing moves and nothing rests: any measure will do
    }

    double product(const vector<double> &a, double a_omega, const vector<double> &b, double b_omega) const {
        return dot(n_, a.data(), b.data()) / (scale_ * scale_) + a_omega * b_omega / (width_ * width_);
    }

    // Unit tangent at the present point from the system's factorization there; oriented along `previous`, or
    // into the range at the start.
    void make_tangent(const State *previous) {
        State t;
        t.x.resize(n_);
        system_.omega_derivative(t.x.data());
        for (double &v : t.x) v = -v;
        system_.solve(t.x.data(), 1);
        t.omega = 1;
        const double size = std::sqrt(product(t.x, t.omega, t.x, t.omega));
        double sign = options_.upward ? 1 : -1;
        if (previous) sign = product(t.x, t.omega, previous->x, previous->omega) < 0 ? -1 : 1;
        for (double &v : t.x) v *= sign / size;
        t.omega *= sign / size;
        tangent_ = std::move(t);
    }

    // Predictor: the tangent, bent by how the tangent turned over the last step (which is dropped after a
    // failure).
    State predict(double step) const {
        State p = now_;
        const bool bent = last_step_ > 0 && !plain_predictor_;
        const double bend = bent ? 0.5 * step * step / last_step_ : 0.0;
        for (std::int64_t i = 0; i < n_; ++i) p.x[i] += step * tangent_.x[i];
        p.omega += step * tangent_.omega;
        if (bent) {
            for (std::int64_t i = 0; i < n_; ++i) p.x[i] += bend * (tangent_.x[i] - last_tangent_.x[i]);
            p.omega += bend * (tangent_.omega - last_tangent_.omega);
        }
        return p;
    }

    NewtonOutcome correct(State &s) {
        vector<double> weight(tangent_.x);
        for (double &w : weight) w /= scale_ * scale_;
        SideCondition side{&weight, tangent_.omega / (width_ * width_)};
        NewtonLimits limits;
        limits.tolerance = options_.tolerance;
        limits.max_iterations = std::min<std::int64_t>(options_.max_iterations, 12);
        limits.min_damping = 0.2;
        limits.omega_scale = width_;
        limits.factored = factored_;
        return newton(system_, side, limits, s.x, s.omega);
    }

    void advance(double &step) {
        State next = predict(step);
        const NewtonOutcome out = correct(next);
        count(out);
        const double moved = out.converged ? distance(next, now_) : 0;
        if (!out.converged || moved > 2 * step || moved < 0.3 * step) return retry(step, out.reason);

        const State before = now_, old_tangent = tangent_;
        now_ = next;
        factored_ = true;
        if (!out.factored_here) linearize_here();
        make_tangent(&old_tangent);
        const double cosine = product(tangent_.x, tangent_.omega, old_tangent.x, old_tangent.omega);
        const double angle = std::acos(std::min(1.0, std::max(-1.0, cosine)));
        if (angle > 1.0 && step > 20 * options_.min_step) { // a corner, or another branch: come closer first
            now_ = before;
            tangent_ = old_tangent;
            factored_ = false;
            return retry(step, PLM_REASON_STEP_MINIMUM);
        }
        accept(out, moved, old_tangent, before);
        double factor = std::min(1.6, std::max(0.35, target_angle / std::max(angle, 1e-6)));
        if (out.iterations > 6) factor = std::min(factor, 0.6);
        step = std::min(options_.max_step, std::max(options_.min_step, step * factor));
    }

    void count(const NewtonOutcome &out) {
        out_.newton_iterations += out.iterations;
        out_.factorizations += out.factorizations;
    }

    double distance(const State &a, const State &b) const {
        vector<double> d(n_);
        for (std::int64_t i = 0; i < n_; ++i) d[i] = a.x[i] - b.x[i];
        return std::sqrt(product(d, a.omega - b.omega, d, a.omega - b.omega));
    }

    void accept(const NewtonOutcome &out, double moved, const State &old_tangent, const State &before) {
        arclength_ += moved;
        last_step_ = moved;
        last_tangent_ = old_tangent;
        plain_predictor_ = false;
        rescued_ = false;
        if (now_.omega < low_ || now_.omega > high_) return leave_range(before);
        record(out.residual, out.iterations);
        const double old_scale = scale_;
        grow_scale();
        if (scale_ != old_scale) last_step_ = 0; // the metric changed: one plain predictor
        if (n_recorded_ > 10 && distance(now_, first_) < 0.5 * moved) end(PLM_REASON_LOOP_CLOSED);
    }

    // The last point lies on the boundary of the range.
    void leave_range(const State &before) {
        const double edge = now_.omega < low_ ? low_ : high_;
        const double part = (edge - before.omega) / (now_.omega - before.omega);
        for (std::int64_t i = 0; i < n_; ++i) now_.x[i] = before.x[i] + part * (now_.x[i] - before.x[i]);
        now_.omega = edge;
        NewtonLimits limits;
        limits.tolerance = options_.tolerance;
        limits.max_iterations = options_.max_iterations;
        limits.omega_scale = width_;
        const NewtonOutcome out = newton(system_, SideCondition(), limits, now_.x, now_.omega);
        count(out);
        if (out.converged && distance(now_, before) < 4 * options_.max_step)
            record(out.residual, out.iterations);
        end(PLM_REASON_RANGE_END);
    }

    // A smaller step with a new factorization; then the other predictor; then a fresh start a little further
    // on.
    void retry(double &step, std::int32_t reason) {
        ++out_.failed_steps;
        factored_ = false;
        plain_predictor_ = out_.failed_steps % 2 == 0;
        step *= 0.4;
        if (step >= options_.min_step) return;
        if (!rescued_ && rescue()) {
            step = 0.05 * options_.max_step;
            return;
        }
        end(reason == PLM_REASON_NONE ? PLM_REASON_STEP_MINIMUM : reason);
    }

    // A solution just beyond, found by the owner's own means; accepted only if it stays close.
    bool rescue() {
        rescued_ = true;
        const double side = tangent_.omega < 0 ? -1 : 1;
        for (double ahead : {1e-4, 1e-3}) {
            State next = now_;
            next.omega = now_.omega + side * ahead * width_;
            if (!owner_.rescue(next.omega, next.x) || distance(next, now_) > options_.max_step) continue;
            const State old_tangent = tangent_;
            arclength_ += distance(next, now_);
            now_ = next;
            linearize_here();
            make_tangent(&old_tangent);
            last_step_ = 0;
            record(0.0, 0);
            return true;
        }
        return false;
    }

    void record(double residual, std::int64_t iterations) {
        ++n_recorded_;
        owner_.record({now_.x, now_.omega, arclength_, residual, iterations});
    }

    static constexpr double target_angle = 0.25; // rad between neighbouring tangents

    HbmSystem &system_;
    const PathOptions &options_;
    PathOwner &owner_;
    std::int64_t n_;
    double low_, high_, width_;
    State now_, first_, tangent_, last_tangent_; // State::omega is the path's parameter
    double scale_ = 0, arclength_ = 0, last_step_ = 0;
    bool factored_ = false, plain_predictor_ = false, rescued_ = false;
    std::int64_t n_recorded_ = 0;
    vector<double> scratch_;
    PathOutcome out_;
};

} // namespace

PathOutcome follow_path(HbmSystem &system, const PathOptions &options, const vector<double> &x,
                        double parameter, double first_residual, PathOwner &owner) {
    return Continuation(system, options, owner).run(x, parameter, first_residual);
}

} // namespace plm
