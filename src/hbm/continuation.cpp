#include "hbm/continuation.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace plm {
namespace {

struct State {
    vector<double> x;
    double omega = 0;
};

// Where a zero is looked for in an interval when the test function has no value at the best place.
constexpr std::array<double, 5> elsewhere = {0.5, 0.75, 0.25, 0.9, 0.1};

double value_of(const vector<double> &tests, std::size_t k) {
    return k < tests.size() ? tests[k] : 0;
}

class Continuation {
  public:
    Continuation(HbmSystem &system, const PathOptions &options, PathOwner &owner)
        : system_(system), options_(options), owner_(owner), n_(system.size()), low_(options.low),
          high_(options.high), width_(high_ - low_), scratch_(n_) {
        kinds_ = {PLM_BIFURCATION_FOLD, PLM_BIFURCATION_BRANCH_POINT};
        for (std::int32_t kind : owner.test_kinds()) kinds_.push_back(kind);
    }

    PathOutcome run(const PathStart &start) {
        begin(start);
        step_ = options_.initial_step > 0 ? options_.initial_step : 0.2 * options_.max_step;
        while (out_.end_reason == PLM_REASON_NONE && !interrupted_) {
            if (n_recorded_ >= options_.max_points) {
                end(PLM_REASON_POINT_LIMIT);
            } else if (owner_.cancelled(progress())) {
                end(PLM_REASON_CANCELLED);
            } else {
                advance(step_);
            }
        }
        out_.x = now_.x;
        out_.parameter = now_.omega;
        out_.direction_x = tangent_.x;
        out_.direction_parameter = tangent_.omega;
        out_.orientation = orientation_;
        out_.scale = scale_;
        out_.arclength = arclength_;
        out_.step = step_;
        out_.n_points = n_recorded_;
        return out_;
    }

  private:
    void begin(const PathStart &start) {
        now_ = {start.x, start.parameter};
        from_start_ = start.end_x.empty();
        target_ = start.end_x.empty() ? now_ : State{start.end_x, start.end_parameter};
        scale_ = start.scale;
        grow_scale();
        linearize_here();
        if (start.direction_x.empty()) {
            make_tangent(nullptr);
        } else {
            const State direction{start.direction_x, start.direction_parameter};
            make_tangent(&direction);
        }
        target_tangent_ =
            start.end_x.empty() ? tangent_ : State{start.end_direction_x, start.end_direction_parameter};
        orientation_ = orientation();
        evaluate(tests_);
        if (start.record) record(start.residual, 0, PLM_BIFURCATION_NONE);
    }

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

    // sign(det) of the tangent bordered by the path's direction: along a path it changes at branch points
    // only, where the path goes straight on, but not at a corner, however sharp.
    double orientation() const { return system_.determinant_sign() * (tangent_.omega < 0 ? -1.0 : 1.0); }

    // The tangent on the side that keeps the orientation of the path.
    void orient() {
        if (orientation() * orientation_ > 0) return;
        for (double &v : tangent_.x) v = -v;
        tangent_.omega = -tangent_.omega;
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

    // Back to the path in the hyperplane across `direction` through the first guess.
    NewtonOutcome correct(State &s, const State &direction, double min_damping, bool factored) {
        vector<double> weight(direction.x);
        for (double &w : weight) w /= scale_ * scale_;
        const SideCondition side{&weight, direction.omega / (width_ * width_)};
        NewtonLimits limits;
        limits.tolerance = options_.tolerance;
        limits.max_iterations = std::min<std::int64_t>(options_.max_iterations, 12);
        limits.min_damping = min_damping;
        limits.omega_scale = width_;
        limits.factored = factored;
        const NewtonOutcome out = newton(system_, side, limits, s.x, s.omega);
        count(out);
        return out;
    }

    void advance(double &step) {
        State next = predict(step);
        const NewtonOutcome out = correct(next, tangent_, 0.2, factored_);
        const double moved = out.converged ? distance(next, now_) : 0;
        if (!out.converged || moved > 2 * step || moved < 0.3 * step) return retry(step, out.reason);

        const State before = now_, old_tangent = tangent_;
        now_ = next;
        factored_ = true;
        if (!out.factored_here) linearize_here();
        make_tangent(&old_tangent);
        const double cosine = product(tangent_.x, tangent_.omega, old_tangent.x, old_tangent.omega);
        const double angle = std::acos(std::min(1.0, std::max(-1.0, cosine)));
        if (angle > sharp_angle &&
            step > 20 * options_.min_step) { // a corner, or another branch: closer first
            now_ = before;
            tangent_ = old_tangent;
            factored_ = false;
            return retry(step, PLM_REASON_STEP_MINIMUM);
        }
        // The steps cannot resolve this corner (contact that begins with a grazing touch bends the path like
        // the square root of the way): beyond a right angle the nearer of the two directions leads back.
        if (angle > sharp_angle) orient();
        if (!accept(out, moved, old_tangent, before)) return retry(step, PLM_REASON_STEP_MINIMUM);
        orientation_ = orientation();
        double factor = std::min(1.6, std::max(0.35, target_angle / std::max(angle, 1e-6)));
        if (out.iterations > 6) factor = std::min(factor, 0.6);
        step = std::min(options_.max_step, std::max(options_.min_step, step * factor));
    }

    void count(const NewtonOutcome &out) {
        out_.newton_iterations += out.iterations;
        out_.newton_seconds += out.seconds;
        out_.factorizations += out.factorizations;
    }

    State difference(const State &a, const State &b) const {
        State d = a;
        for (std::int64_t i = 0; i < n_; ++i) d.x[i] -= b.x[i];
        d.omega -= b.omega;
        return d;
    }

    double distance(const State &a, const State &b) const {
        const State d = difference(a, b);
        return std::sqrt(product(d.x, d.omega, d.x, d.omega));
    }

    // False: the step crossed to another curve, see find_zero; the path is back before it.
    bool accept(const NewtonOutcome &out, double moved, const State &old_tangent, const State &before) {
        last_step_ = moved;
        last_tangent_ = old_tangent;
        plain_predictor_ = false;
        rescued_ = false;
        if (now_.omega < low_ || now_.omega > high_) return leave_range(before, old_tangent);
        const vector<double> old_tests = tests_;
        evaluate(tests_);
        for (std::size_t k = 0; k < tests_.size(); ++k) // its sign is that of the last known value
            if (std::isnan(tests_[k])) tests_[k] = value_of(old_tests, k);
        jumped_ = false;
        locate(before, old_tangent, moved, old_tests);
        if (jumped_ && moved > 20 * options_.min_step) {
            tests_ = old_tests;
            last_step_ = 0;
            restore(before, old_tangent);
            return false;
        }
        arclength_ += moved;
        if (passes_start(before, moved)) {
            if (product(tangent_.x, tangent_.omega, target_tangent_.x, target_tangent_.omega) > 0) {
                close_loop();
                return true;
            }
            if (is_start(before)) {
                end(PLM_REASON_TURNED_BACK);
                return true;
            }
        }
        record(out.residual, out.iterations, PLM_BIFURCATION_NONE);
        const double old_scale = scale_;
        grow_scale();
        if (scale_ != old_scale) last_step_ = 0; // the metric changed: one plain predictor
        interrupted_ = owner_.interrupt();
        return true;
    }

    // The step from `before` passed the point where the path began.
    bool passes_start(const State &before, double moved) const {
        if (from_start_ && n_recorded_ < 6) return false;
        const State chord = difference(now_, before), back = difference(target_, before);
        const double along = product(chord.x, chord.omega, back.x, back.omega) / (moved * moved);
        if (!(along > 0 && along <= 1)) return false;
        const double distance = std::sqrt(product(back.x, back.omega, back.x, back.omega));
        return std::sqrt(std::max(0.0, distance * distance - along * along * moved * moved)) < 0.2 * moved;
    }

    // Whether the solution on the present step at the parameter of the start is the start itself.
    bool is_start(const State &before) {
        const double width = now_.omega - before.omega;
        const double part = width != 0 ? (target_.omega - before.omega) / width : 1;
        State at = before;
        for (std::int64_t i = 0; i < n_; ++i) at.x[i] += part * (now_.x[i] - before.x[i]);
        at.omega = target_.omega;
        const bool same = at_frequency(at).converged && distance(at, target_) < same_solution;
        linearize_here();
        return same;
    }

    NewtonOutcome at_frequency(State &s) {
        NewtonLimits limits;
        limits.tolerance = options_.tolerance;
        limits.max_iterations = options_.max_iterations;
        limits.omega_scale = width_;
        const NewtonOutcome out = newton(system_, SideCondition(), limits, s.x, s.omega);
        count(out);
        return out;
    }

    void close_loop() {
        now_ = target_;
        linearize_here();
        record(0.0, 0, PLM_BIFURCATION_NONE);
        end(PLM_REASON_LOOP_CLOSED);
    }

    // --- test functions: the tangent's share of p (fold), the smallest stretch of the bordered tangent
    // (branch point), the owner's
    void evaluate(vector<double> &tests) {
        if (!options_.locate) return;
        vector<double> mine;
        owner_.test(now_.x, now_.omega, mine);
        tests = {tangent_.omega * width_, branch_test()};
        tests.insert(tests.end(), mine.begin(), mine.end());
    }

    // sign(det) of the tangent bordered by the path's direction, over the size of its solution for a fixed
    // right-hand side: passes through zero like the smallest singular value.
    double branch_test() {
        vector<double> a(n_), border(n_);
        for (std::int64_t i = 0; i < n_; ++i)
            a[i] = 0.5 + std::fmod(0.754877666 * static_cast<double>(i + 1), 1.0);
        system_.solve(a.data(), 1);
        system_.omega_derivative(border.data());
        system_.solve(border.data(), 1);
        const double along = tangent_.omega * dot(n_, tangent_.x.data(), a.data()) / (scale_ * scale_);
        for (std::int64_t i = 0; i < n_; ++i) a[i] += along * border[i];
        const double size = norm2(n_, a.data());
        return size > 0 && std::isfinite(size) ? orientation() / size : 0;
    }

    struct Crossing {
        double position = 0; // on the chord, 0 to 1
        State state;
        std::int32_t kind = 0;
        double residual = 0;
    };

    // Records what lies between `before` and the present point, in order, and comes back to the latter.
    void locate(const State &before, const State &old_tangent, double moved,
                const vector<double> &old_tests) {
        if (!options_.locate) return;
        const State after = now_, new_tangent = tangent_;
        std::vector<Crossing> found;
        for (std::size_t k = 0; k < kinds_.size(); ++k) {
            const double left = value_of(old_tests, k), right = value_of(tests_, k);
            if (!(left * right < 0)) continue;
            const Step step{before, after, old_tangent, new_tangent, moved};
            Crossing c;
            if (find_zero(step, k, left, right, c)) found.push_back(std::move(c));
        }
        if (found.empty()) {
            if (now_.omega != after.omega || now_.x != after.x) restore(after, new_tangent);
            return;
        }
        std::sort(found.begin(), found.end(),
                  [](const Crossing &a, const Crossing &b) { return a.position < b.position; });
        const double base = arclength_;
        for (const Crossing &c : found) {
            restore(c.state, new_tangent);
            arclength_ = base + c.position * moved;
            record(c.residual, 0, c.kind);
        }
        arclength_ = base;
        restore(after, new_tangent);
    }

    void restore(const State &s, const State &tangent) {
        now_ = s;
        linearize_here();
        tangent_ = tangent;
    }

    struct Step {
        const State &before, &after, &tangent_before, &tangent_after;
        double length;
    };

    // Cubic through both ends with their tangents.
    State between(const Step &s, double t) const {
        const double b = t * t * (3 - 2 * t), a = 1 - b, da = s.length * t * (1 - t) * (1 - t),
                     db = s.length * t * t * (t - 1);
        State p = s.before;
        for (std::int64_t i = 0; i < n_; ++i)
            p.x[i] =
                a * s.before.x[i] + b * s.after.x[i] + da * s.tangent_before.x[i] + db * s.tangent_after.x[i];
        p.omega =
            a * s.before.omega + b * s.after.omega + da * s.tangent_before.omega + db * s.tangent_after.omega;
        return p;
    }

    // The point of the path at t of the way with its test functions; leaves it as the present point.
    bool move_to(const Step &s, double t, const State &chord, vector<double> &tests, double &residual) {
        State p = between(s, t);
        const NewtonOutcome out = correct(p, chord, 1e-3, false);
        if (!out.converged) return false;
        residual = out.residual;
        now_ = std::move(p);
        linearize_here();
        make_tangent(&s.tangent_before);
        if (product(s.tangent_before.x, s.tangent_before.omega, s.tangent_after.x, s.tangent_after.omega) <
            std::cos(sharp_angle))
            orient();
        evaluate(tests);
        return true;
    }

    // Regula falsi (Illinois) with bisection on the chord. False when the function jumps instead of
    // vanishing (but for a corner at which p turns round); the step then may have crossed to another curve.
    bool find_zero(const Step &s, std::size_t k, double left, double right, Crossing &c) {
        const State chord = difference(s.after, s.before);
        const double size = std::min(std::abs(left), std::abs(right));
        double a = 0, b = 1, best = 1e300;
        int last_side = 0;
        std::size_t unknown = 0; // times in a row that the function had no value (stability at a fold)
        State below = s.before, above = s.after;
        for (int i = 0; i < 60 && b - a > 1e-10; ++i) {
            double t = i % 4 == 3 ? 0.5 * (a + b) : (a * right - b * left) / (right - left);
            if (unknown > 0) t = a + elsewhere[unknown - 1] * (b - a);
            t = std::min(b - 1e-3 * (b - a), std::max(a + 1e-3 * (b - a), t));
            vector<double> tests;
            double residual = 0;
            if (!move_to(s, t, chord, tests, residual)) break;
            const double value = value_of(tests, k);
            if (std::isnan(value) && ++unknown > elsewhere.size()) break;
            if (std::isnan(value)) continue;
            unknown = 0;
            if (std::abs(value) < best) {
                best = std::abs(value);
                c = {t, now_, kinds_[k], residual};
            }
            if (best <= 1e-9 * size) break;
            const bool keeps_left = value * left > 0;
            if (keeps_left) {
                if (last_side == 1) right *= 0.5;
                a = t, left = value, last_side = 1, below = now_;
            } else {
                if (last_side == -1) left *= 0.5;
                b = t, right = value, last_side = -1, above = now_;
            }
            if (distance(below, above) > 20 * (b - a) * s.length) break;
        }
        if (best <= 1e-3 * size) return true;
        if (kinds_[k] == PLM_BIFURCATION_FOLD && is_corner_fold(s, below, above, c)) return true;
        jumped_ = jumped_ || kinds_[k] == PLM_BIFURCATION_BRANCH_POINT;
        return false;
    }

    // Where contact begins or, with sampled forces, at the switching of a sample the path has a corner: p
    // turns round there without its derivative passing zero. `below` and `above` enclose the zero of the
    // fold's test.
    bool is_corner_fold(const Step &s, const State &below, const State &above, Crossing &c) const {
        if (distance(below, above) > std::max(1e-3 * s.length, options_.min_step)) return false; // a jump
        const double up = s.tangent_before.omega > 0 ? 1 : -1;
        const State &top = up * below.omega > up * above.omega ? below : above;
        c.state = top;
        return true;
    }

    // The last point lies on the boundary of the range. False: it was not found; the path is back before.
    bool leave_range(const State &before, const State &old_tangent) {
        const double edge = now_.omega < low_ ? low_ : high_;
        const double part = (edge - before.omega) / (now_.omega - before.omega);
        for (std::int64_t i = 0; i < n_; ++i) now_.x[i] = before.x[i] + part * (now_.x[i] - before.x[i]);
        now_.omega = edge;
        const NewtonOutcome out = at_frequency(now_);
        const double moved = distance(now_, before);
        if (!out.converged || moved > 4 * options_.max_step) {
            last_step_ = 0;
            restore(before, old_tangent);
            return false;
        }
        end(PLM_REASON_RANGE_END);
        // a path that begins on the boundary and leaves at once has its last point already
        if (moved < options_.min_step) return true;
        if (target_.omega == edge && n_recorded_ > 1 && distance(now_, target_) < same_solution)
            end(PLM_REASON_TURNED_BACK);
        linearize_here();
        make_tangent(&old_tangent);
        const vector<double> old_tests = tests_;
        evaluate(tests_);
        locate(before, old_tangent, moved, old_tests);
        arclength_ += moved;
        record(out.residual, out.iterations, PLM_BIFURCATION_NONE);
        return true;
    }

    // A smaller step with a new factorization; then the other predictor; then a fresh start a little further
    // on.
    void retry(double &step, std::int32_t reason) {
        ++out_.failed_steps;
        factored_ = false;
        plain_predictor_ = out_.failed_steps % 2 == 0;
        step *= 0.4;
        if (step >= options_.min_step) return;
        if (turn_corner(step)) return;
        if (!rescued_ && rescue()) {
            step = 0.05 * options_.max_step;
            return;
        }
        end(reason == PLM_REASON_NONE ? PLM_REASON_STEP_MINIMUM : reason);
    }

    // Contact that begins with a grazing touch adds stiffness like the square root of the way: the path turns
    // within any step by an angle that may exceed a right one, and the plane across the step then misses it.
    // Its direction beyond is that of the tangent matrix a step ahead, on the side that the orientation says.
    bool turn_corner(double &step) {
        const State before = now_, old_tangent = tangent_;
        for (double length = 10 * options_.min_step; length < 0.01 * options_.max_step; length *= 10) {
            last_step_ = 0;
            const State ahead = predict(length);
            system_.residual(ahead.x.data(), ahead.omega, scratch_.data());
            system_.linearize();
            ++out_.factorizations;
            make_tangent(nullptr);
            orient();
            const State direction = tangent_;
            tangent_ = old_tangent;
            const double cosine = product(direction.x, direction.omega, tangent_.x, tangent_.omega);
            if (cosine > std::cos(sharp_angle)) continue;
            State next = ahead; // so that Newton's method begins on the other side of the corner
            for (std::int64_t i = 0; i < n_; ++i) next.x[i] += length * (1 - cosine) * direction.x[i];
            next.omega += length * (1 - cosine) * direction.omega;
            const NewtonOutcome out = correct(next, direction, 0.2, false);
            const double moved = out.converged ? distance(next, before) : 0;
            if (!out.converged || moved > 2 * length || moved < 0.3 * length) continue;
            now_ = next;
            linearize_here();
            make_tangent(nullptr);
            orient();
            if (product(direction.x, direction.omega, tangent_.x, tangent_.omega) > 0.5 &&
                accept(out, moved, old_tangent, before)) {
                last_step_ = 0;
                factored_ = false;
                step = length;
                return true;
            }
            now_ = before;
            tangent_ = old_tangent;
        }
        return false;
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
            orientation_ = orientation();
            last_step_ = 0;
            evaluate(tests_);
            record(0.0, 0, PLM_BIFURCATION_NONE);
            return true;
        }
        return false;
    }

    void record(double residual, std::int64_t iterations, std::int32_t bifurcation) {
        ++n_recorded_;
        owner_.record({now_.x, now_.omega, arclength_, residual, iterations, bifurcation});
    }

    static constexpr double target_angle = 0.25; // rad between neighbouring tangents
    static constexpr double sharp_angle = 0.6;
    static constexpr double same_solution = 1e-6; // distance of two solutions that were computed twice

    HbmSystem &system_;
    const PathOptions &options_;
    PathOwner &owner_;
    std::int64_t n_;
    double low_, high_, width_;
    State now_, target_, tangent_, target_tangent_, last_tangent_; // State::omega is the path's parameter
    double scale_ = 0, arclength_ = 0, last_step_ = 0, step_ = 0, orientation_ = 1;
    bool factored_ = false, plain_predictor_ = false, rescued_ = false, interrupted_ = false,
         from_start_ = true;
    std::vector<std::int32_t> kinds_; // of the test functions
    bool jumped_ = false;             // the last step seems to have crossed to another curve
    vector<double> tests_;            // at the present point
    std::int64_t n_recorded_ = 0;
    vector<double> scratch_;
    PathOutcome out_;
};

} // namespace

PathOutcome follow_path(HbmSystem &system, const PathOptions &options, const PathStart &start,
                        PathOwner &owner) {
    return Continuation(system, options, owner).run(start);
}

} // namespace plm
