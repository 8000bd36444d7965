#include "paths/newton.hpp"
#include "linalg/dense.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>

namespace plm {
namespace {

constexpr double fast_contraction = 0.2; // below: the old factorization is good enough for another step
constexpr double good_contraction = 0.5; // below: the damping was far too strong
constexpr double bold_growth = 4, careful_growth = 1.5; // of the damping factor after a damped step
// Between one trial and the next the damping factor is halved at least, whatever the estimate says, and not
// made much smaller than the estimate, from one trial alone, is worth.
constexpr double strongest_cut = 0.1, weakest_cut = 0.5;
constexpr double rounding = 1e-14; // of the whole solution, static part included: what a correction can be
constexpr std::size_t least_pieces =
    6; // factorizations after which coming back to the same pieces is no chance

constexpr double negligible = 1e-3; // of the tolerance: as small as a last correction leaves the next one
// Of the tolerance: what a last correction by an old tangent may leave; and where that is no more than a
// share of something else's, so that one more digit is worth nothing.
constexpr double remainder = 1e-2, loose_remainder = 0.1, loose = 1e-7;

class Newton {
  public:
    Newton(Residual &system, const SideCondition &side, const NewtonLimits &limits, vector<double> &x,
           double &parameter)
        : system_(system), side_(side), limits_(limits), x_(x), parameter_(parameter), n_(system.size()),
          r_(n_), step_(n_), border_(n_), trial_(n_), next_(n_), cheap_(system.is_cheap_to_linearize()) {
        pieces_.reserve(limits.max_iterations + 1); // no iteration allocates
    }

    NewtonOutcome run() {
        const bool kept = limits_.factored && !cheap_;
        if (kept && limits_.slope)
            border_ = *limits_.slope;
        else if (kept)
            make_border(); // at the point the factorization belongs to, before residual() moves it
        system_.residual(x_.data(), parameter_, r_.data());
        if (!kept) refactor();
        double size = correction(r_, step_, step_parameter_);
        double damping = 1;
        while (out_.iterations < limits_.max_iterations) {
            ++out_.iterations;
            worked(1e5); // what the smallest system takes for an iteration, in time
            if (!std::isfinite(size)) return fail(reason::singular_tangent);
            if (size <= allowed() && (fresh_ || !cheap_)) {
                apply(1.0, step_, step_parameter_);
                return cheap_ ? finish_here(size) : finish(size);
            }
            const double trial_parameter = propose(damping);
            system_.residual(trial_.data(), trial_parameter, r_.data());
            double next_parameter = 0;
            const double next_size = correction(r_, next_, next_parameter);
            const double contraction = next_size / size;
            if (std::isfinite(contraction) && contraction <= 1 - damping / 4) { // natural monotonicity
                x_ = trial_;
                parameter_ = trial_parameter;
                if (fresh_ && next_size <= nothing()) { // a correction was found, and is not worth making
                    ++out_.iterations;
                    return finish(damping * size);
                }
                if (cheap_ && damping == 1 && is_last(next_size, contraction)) {
                    ++out_.iterations;
                    apply(1.0, next_, next_parameter);
                    return finish_here(size);
                }
                fresh_ = false;
                if (damping == 1 && serves_again(next_size, contraction)) {
                    step_.swap(next_);
                    step_parameter_ = next_parameter;
                    size = next_size;
                    continue;
                }
                refactor();
                size = correction(r_, step_, step_parameter_);
                damping =
                    std::min(1.0, damping * (contraction < good_contraction ? bold_growth : careful_growth));
                continue;
            }
            if (!fresh_) { // the old factorization does not serve here: a new one before any damping
                system_.residual(x_.data(), parameter_, r_.data());
                refactor();
                size = correction(r_, step_, step_parameter_);
                continue;
            }
            if (size <= limits_.tolerance) return finish(size); // more is lost in rounding
            damping = smaller_damping(damping, size, next_parameter);
            if (damping < limits_.min_damping)
                return fail(pieces_repeat() ? reason::contact_chatter : reason::step_minimum);
        }
        if (size <= limits_.tolerance) return finish(size);
        return fail(pieces_repeat() ? reason::contact_chatter : reason::step_minimum);
    }

  private:
    // The correction by a tangent of some point before leaves a part of itself.
    bool is_last(double size, double contraction) const {
        return size <= allowed() && contraction * size <= left_at_last() * goal() + smallest();
    }
    double left_at_last() const { return goal() < loose ? remainder : loose_remainder; }
    // Whether the factorization serves for the correction after that, too. One that costs less than a
    // residual is made anew, since it gains as many digits as there are, unless the old one suffices for the
    // last.
    bool serves_again(double size, double contraction) const {
        return cheap_ ? contraction * size <= allowed() : contraction <= fast_contraction;
    }

    void refactor() {
        const Tangent tangent = system_.linearize_roughly();
        ++out_.factorizations;
        rough_ = tangent != Tangent::exact;
        fresh_ = tangent != Tangent::guessed;
        pieces_.push_back(system_.piece());
        make_border();
    }

    // -(dR/dx)^-1 dR/dp at the point of the factorization; needed only when p is free.
    void make_border() {
        if (!side_.x_weight) return;
        system_.parameter_derivative(border_.data());
        for (double &b : border_) b = -b;
        system_.solve(border_.data(), 1);
    }

    // Newton correction for residual r with the present factorization; returns its size. r is kept.
    double correction(const vector<double> &r, vector<double> &step, double &step_parameter) {
        for (std::int64_t i = 0; i < n_; ++i) step[i] = -r[i];
        system_.solve(step.data(), 1);
        step_parameter = 0;
        if (side_.x_weight) {
            const double along = dot(n_, side_.x_weight->data(), step.data());
            const double slope = dot(n_, side_.x_weight->data(), border_.data()) + side_.parameter_weight;
            step_parameter = -along / slope;
            for (std::int64_t i = 0; i < n_; ++i) step[i] += step_parameter * border_[i];
        }
        return std::hypot(norm2(n_, step.data()) / scale(), step_parameter / limits_.parameter_scale);
    }

    // What the answer's accuracy refers to.
    double scale() const {
        const double size = size_of(system_, x_);
        return size > 0 ? size : 1;
    }

    // Rounding of the static part bounds what can be reached.
    double allowed() const { return goal() + smallest(); }
    double goal() const { return std::min(limits_.tolerance, limits_.aim); }
    double smallest() const { return rounding * norm2(n_, x_.data()) / scale(); }
    // A correction not worth making.
    double nothing() const { return negligible * goal() + smallest(); }

    double propose(double damping) {
        for (std::int64_t i = 0; i < n_; ++i) trial_[i] = x_[i] + damping * step_[i];
        return parameter_ + damping * step_parameter_;
    }

    void apply(double factor, const vector<double> &step, double step_parameter) {
        for (std::int64_t i = 0; i < n_; ++i) x_[i] += factor * step[i];
        parameter_ += factor * step_parameter;
    }

    // Deuflhard's estimate of the damping that the local curvature allows.
    double smaller_damping(double damping, double size, double next_parameter) {
        for (std::int64_t i = 0; i < n_; ++i) next_[i] -= (1 - damping) * step_[i];
        const double change =
            std::hypot(norm2(n_, next_.data()) / scale(),
                       (next_parameter - (1 - damping) * step_parameter_) / limits_.parameter_scale);
        const double estimate = change > 0 ? 0.5 * damping * damping * size / change : 0.0;
        return std::min(weakest_cut * damping, std::max(estimate, strongest_cut * damping));
    }

    // Newton cycles between smooth pieces.
    bool pieces_repeat() const {
        if (pieces_.size() < least_pieces) return false;
        const auto last = pieces_.end();
        return *(last - 1) == *(last - 3) && *(last - 2) == *(last - 4) && *(last - 1) != *(last - 2);
    }

    // size: of the correction from where the system was factored last, if that is fresh.
    NewtonOutcome finish(double size) {
        system_.residual(x_.data(), parameter_, r_.data());
        return finish_here(size);
    }
    // The system stands no farther from the solution than a last correction.
    NewtonOutcome finish_here(double size) {
        const double scale = system_.residual_scale();
        out_.residual = scale > 0 ? norm2(n_, r_.data()) / scale : norm2(n_, r_.data());
        out_.converged = std::isfinite(out_.residual) && system_.in_balance();
        if (fresh_ && !rough_) out_.factored_away = size;
        return out_;
    }

    NewtonOutcome fail(std::int32_t reason) {
        out_.reason = reason;
        return out_;
    }

    Residual &system_;
    const SideCondition &side_;
    const NewtonLimits &limits_;
    vector<double> &x_;
    double &parameter_;
    std::int64_t n_;
    vector<double> r_, step_, border_, trial_, next_;
    const bool cheap_; // to linearize
    double step_parameter_ = 0;
    bool fresh_ = false; // the factorization belongs to x_
    bool rough_ = false; // and is not quite that
    vector<std::int64_t> pieces_;
    NewtonOutcome out_;
};

} // namespace

NewtonWork &NewtonWork::operator+=(const NewtonWork &more) {
    iterations += more.iterations;
    factorizations += more.factorizations;
    seconds += more.seconds;
    return *this;
}

NewtonOutcome newton(Residual &system, const SideCondition &side, const NewtonLimits &limits,
                     vector<double> &x, double &parameter) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    NewtonOutcome out = Newton(system, side, limits, x, parameter).run();
    out.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return out;
}

NewtonOutcome newton_at(Residual &system, const NewtonLimits &limits, vector<double> &x, double parameter) {
    return newton(system, SideCondition(), limits, x, parameter);
}

NewtonOutcome newton_across(Residual &system, const Metric &metric, const PathState &direction,
                            NewtonLimits limits, PathState &at) {
    vector<double> weight(direction.x);
    for (std::size_t i = 0; i < weight.size(); ++i)
        weight[i] *= (metric.weights ? (*metric.weights)[i] : 1) / (metric.scale * metric.scale);
    limits.parameter_scale = metric.width;
    return newton(system, {&weight, direction.parameter / (metric.width * metric.width)}, limits, at.x,
                  at.parameter);
}

} // namespace plm
