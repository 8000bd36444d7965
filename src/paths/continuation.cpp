#include "paths/continuation.hpp"
#include "linalg/error.hpp"
#include "paths/path_guide.hpp"
#include "paths/path_return.hpp"
#include "paths/special_points.hpp"
#include "paths/step_length.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// The length of a step: step_length.hpp.
constexpr double after_failure = 0.4; // of the step that failed
constexpr double first_step = 0.2,
                 step_after_rescue = 0.05; // of the largest: nothing is known of the path ahead

// Than the longest steps of its own is one that a neighbouring path shows the end of.
constexpr double longer_if_foreseen = 4;

// Where a correction may lead: it moves in the plane across the step, so that the distance from the last
// point is about that step, unless it has come upon another piece of the path.
constexpr double shortest_move = 0.3, longest_move = 2; // of the step
constexpr double longest_last_move = 4;                 // of the largest step, to the boundary of the range
constexpr double across_damping = 0.2; // a step that Newton's method must damp more than this is too long

// A factorization has the tangent and the tests of a point (PathWalker::at_the_point) if it is also so near,
// beside the step that led there.
constexpr double share_of_step = 1e-3;

// A step that turned sharply or seems to have crossed to another curve is tried again, shorter, while it is
// longer than so many of the smallest: three failures away from it.
constexpr double shortenable = 20;

// Lengths tried to get round a corner: from a few of the smallest steps, which cannot resolve it, to what is
// still a corner seen from steps of the usual length.
constexpr double corner_from = 10, corner_growth = 10; // of the smallest step
constexpr double corner_to = 0.01;                     // of the largest
constexpr int corner_attempts = 6;                     // with each
constexpr double beyond_corner = 0.5; // cosine of the tangent found there with the one expected: 60 degrees

// Ahead of a point where the path is stuck, of the range of p: near enough to be on the same branch.
constexpr double rescue_distances[] = {1e-4, 1e-3};
constexpr int most_rescues = 5; // more lead in circles: back to where the path came from

class Continuation {
  public:
    Continuation(Residual &system, const PathOptions &options, PathOwner &owner)
        : walker_(system, options, owner), options_(options), owner_(owner), back_(walker_, system.size()),
          way_(options.max_step) {}

    PathOutcome run(const PathStart &start) {
        begin(start);
        return run();
    }

    PathOutcome run(const PathProgress &from) {
        if (!walker_.go_on(from))
            throw Error(status::argument,
                        "what is known of where the curve stands is not of these equations");
        back_.go_on(from);
        static_cast<PathProgress &>(out_) = from;
        return run();
    }

  private:
    void begin(const PathStart &start) {
        walker_.move(start.at);
        walker_.take_scale(start.scale);
        walker_.linearize_here();
        walker_.make_tangent(start.direction.x.empty() ? nullptr : &start.direction);
        const bool closes_here = start.end.x.empty();
        back_.begin(closes_here ? start.at : start.end, closes_here ? walker_.tangent() : start.end_direction,
                    closes_here);
        out_.orientation = walker_.orientation();
        out_.tests = walker_.tests();
        if (start.record) record(start.residual, 0, bifurcation::none);
        out_.step = options_.initial_step > 0 ? options_.initial_step : first_step * options_.max_step;
    }

    PathOutcome run() {
        while (out_.end_reason == reason::none && !interrupted_) {
            if (out_.n_recorded >= options_.max_points) {
                end(reason::point_limit);
            } else if (owner_.cancelled(progress())) {
                end(reason::cancelled);
            } else {
                advance();
            }
        }
        out_.at = walker_.now();
        out_.direction = walker_.tangent();
        out_.scale = walker_.metric().scale;
        back_.put(out_);
        out_.work = walker_.work;
        return out_;
    }

    void end(std::int32_t reason) { out_.end_reason = reason; }

    double progress() const {
        const double p = walker_.now().parameter;
        const double done = (options_.upward ? p - options_.low : options_.high - p) / walker_.metric().width;
        return std::min(1.0, std::max(0.0, done));
    }

    // The tangent, bent by how it turned over the last step (which is dropped after a failure).
    PathState predict(double step) const {
        PathState p = walker_.now();
        add(step, walker_.tangent(), p);
        if (out_.last_step > 0 && !out_.plain_predictor)
            add(0.5 * step * step / out_.last_step, difference(walker_.tangent(), out_.last_direction), p);
        return p;
    }

    // Whether a correction came out about where the step went.
    static bool is_near(const NewtonOutcome &out, double moved, double step) {
        return out.converged && moved <= longest_move * step && moved >= shortest_move * step;
    }

    void advance() {
        PathState next, across = walker_.tangent();
        foreseen_ = !astray_ && options_.guide &&
                    options_.guide->foresee(walker_.now(), walker_.tangent(), walker_.metric(),
                                            longer_if_foreseen * way_, next, across);
        if (!foreseen_) next = predict(out_.step);
        const double step = foreseen_ ? walker_.metric().distance(next, walker_.now()) : out_.step;
        const NewtonOutcome out = walker_.correct(next, across, across_damping, walker_.is_factored());
        const double moved = out.converged ? walker_.metric().distance(next, walker_.now()) : 0;
        if (!is_near(out, moved, step)) return retry(out.reason);
        const PathState before = walker_.now(), old_tangent = walker_.tangent();
        const vector<double> old_tests = out_.tests;
        walker_.move(std::move(next));
        walker_.set_factored(true);
        if (!(out.factored_away < std::min(PathWalker::at_the_point, share_of_step * moved)))
            walker_.linearize_at_solution();
        walker_.make_tangent(&old_tangent);
        const double turn = walker_.angle_with_tangent(old_tangent),
                     angle = foreseen_ ? walker_.angle_with_tangent(across) : turn; // not as expected
        if (angle > PathWalker::sharp_angle &&
            out_.step > shortenable * options_.min_step) { // a corner: closer first
            walker_.move(before);
            walker_.set_tangent(old_tangent);
            return retry(reason::step_minimum);
        }
        // The steps cannot resolve this corner (contact that begins with a grazing touch bends the path like
        // the square root of the way): beyond a right angle the nearer of the two directions leads back.
        if (angle > PathWalker::sharp_angle) walker_.orient(out_.orientation);
        if (!accept(out, moved, old_tangent, before)) return retry(reason::step_minimum);
        astray_ = false;
        if (angle > PathWalker::sharp_angle) out_.last_step = 0; // a corner is no bend
        out_.orientation = walker_.orientation();
        way_ = way_to_change(old_tests, out_.tests, moved, options_.max_step);
        out_.step = std::min(way_, out_.step * step_growth(turn * out_.step / step, out));
        out_.step = std::min(options_.max_step, std::max(options_.min_step, out_.step));
    }

    // False: the step crossed to another curve, see find_special_points(); the path is back before it.
    bool accept(const NewtonOutcome &out, double moved, const PathState &old_tangent,
                const PathState &before) {
        out_.last_step = moved;
        out_.last_direction = old_tangent;
        out_.plain_predictor = false;
        out_.rescued = false;
        const double p = walker_.now().parameter;
        if (p < options_.low || p > options_.high) return leave_range(before, old_tangent);
        const vector<double> old_tests = out_.tests;
        out_.tests = walker_.tests();
        for (std::size_t k = 0; k < std::min(out_.tests.size(), old_tests.size()); ++k)
            if (std::isnan(out_.tests[k]))
                out_.tests[k] = old_tests[k]; // its sign is that of the last known value
        if (!locate(before, old_tangent, moved, old_tests)) return false;
        out_.arclength += moved;
        const std::int32_t came_back = back_.by_step(before, moved, out_.n_recorded);
        if (came_back == reason::loop_closed) {
            close_loop();
            return true;
        }
        if (came_back != reason::none) {
            end(came_back);
            return true;
        }
        record(out.residual, out.iterations, bifurcation::none);
        back_.pass();
        if (walker_.take_scale()) { // how the path bent, in the new metric
            out_.last_step = walker_.metric().distance(walker_.now(), before);
            scale_by(1 / walker_.metric().length(out_.last_direction), out_.last_direction);
        }
        interrupted_ = owner_.interrupt();
        return true;
    }

    void close_loop() {
        walker_.move(back_.target());
        walker_.linearize_here();
        record(0.0, 0, bifurcation::none);
        end(reason::loop_closed);
    }

    // Records what lies between `before` and the present point, in order, and comes back to the latter.
    // False: the step seems to have crossed to another curve and can be tried shorter; the path is back
    // before it.
    bool locate(const PathState &before, const PathState &old_tangent, double moved,
                const vector<double> &old_tests) {
        if (!any_special_points(old_tests, out_.tests)) return true;
        const PathState after = walker_.now(), new_tangent = walker_.tangent();
        walker_.remember();
        const SpecialPoints special =
            find_special_points(walker_, options_, {before, after, old_tangent, new_tangent, moved},
                                out_.orientation, old_tests, out_.tests);
        if (special.jumped && moved > shortenable * options_.min_step) {
            out_.tests = old_tests;
            go_back(before, old_tangent);
            return false;
        }
        const double base = out_.arclength;
        for (const SpecialPoint &point : special.found) {
            walker_.restore(point.at, new_tangent);
            out_.arclength = base + point.position * moved;
            record(point.residual, 0, point.kind);
        }
        out_.arclength = base;
        walker_.come_back();
        return true;
    }

    // A step came to nothing.
    void go_back(const PathState &before, const PathState &tangent) {
        out_.last_step = 0;
        walker_.restore(before, tangent);
    }

    // The last point lies on the boundary of the range. False: it was not found, or the way to it is not one
    // curve; the path is back before.
    bool leave_range(const PathState &before, const PathState &old_tangent) {
        PathState last = walker_.now();
        const double edge = last.parameter < options_.low ? options_.low : options_.high;
        const double part = (edge - before.parameter) / (last.parameter - before.parameter);
        for (std::size_t i = 0; i < last.x.size(); ++i)
            last.x[i] = before.x[i] + part * (last.x[i] - before.x[i]);
        last.parameter = edge;
        const NewtonOutcome out = walker_.correct_at_parameter(last);
        const double moved = walker_.metric().distance(last, before);
        if (!out.converged || moved > longest_last_move * options_.max_step) {
            go_back(before, old_tangent);
            return false;
        }
        walker_.move(std::move(last));
        // a path that begins on the boundary and leaves at once has its last point already
        const bool is_new = moved >= options_.min_step,
                   is_start = is_new && back_.target().parameter == edge && out_.n_recorded > 1 &&
                              back_.is_target(walker_.now());
        if (is_new && !record_last(out, before, old_tangent, moved)) return false;
        end(is_start ? reason::turned_back : reason::range_end);
        return true;
    }

    bool record_last(const NewtonOutcome &out, const PathState &before, const PathState &old_tangent,
                     double moved) {
        walker_.linearize_here();
        walker_.make_tangent(&old_tangent);
        const vector<double> old_tests = out_.tests;
        out_.tests = walker_.tests();
        if (!locate(before, old_tangent, moved, old_tests)) return false;
        out_.arclength += moved;
        record(out.residual, out.iterations, bifurcation::none);
        return true;
    }

    // A smaller step with a new factorization; then the other predictor; then a fresh start a little further
    // on.
    void retry(std::int32_t reason) {
        ++out_.failed_steps;
        ++out_.failed_now;
        walker_.set_factored(false);
        astray_ = astray_ || foreseen_;
        if (foreseen_) return; // the next step is one of its own
        out_.plain_predictor = out_.failed_steps % 2 == 0;
        out_.step *= after_failure;
        if (out_.step >= options_.min_step) return;
        if (turn_corner()) return;
        if (!out_.rescued && out_.n_rescues < most_rescues && rescue()) {
            out_.step = step_after_rescue * options_.max_step;
            return;
        }
        end(reason == reason::none ? reason::step_minimum : reason);
    }

    // Contact that begins with a grazing touch adds stiffness like the square root of the way: the path turns
    // within any step by an angle that may exceed a right one, and the plane across the step then misses it.
    // Contact so stiff that it is an impact has a velocity in proportion to the way along the path beyond:
    // only about the square of that way leads into contact, and Newton's method wants to begin with less.
    bool turn_corner() {
        for (double length = corner_from * options_.min_step; length < corner_to * options_.max_step;
             length *= corner_growth) {
            double into = length;
            for (int k = 0; k < corner_attempts; ++k) {
                PathState direction;
                if (!turns_ahead(into, direction)) break;
                if (step_beyond(length, into, direction)) return true;
                into = k == 0 ? length * length : 0.5 * into;
            }
        }
        return false;
    }

    // Whether the path turns within a step of this length: the direction beyond is that of the tangent matrix
    // there, on the side that the orientation says.
    bool turns_ahead(double length, PathState &direction) {
        const PathState tangent = walker_.tangent();
        out_.last_step = 0;
        walker_.linearize_at(predict(length));
        walker_.make_tangent(nullptr);
        walker_.orient(out_.orientation);
        direction = walker_.tangent();
        walker_.set_tangent(tangent);
        return walker_.cosine_with_tangent(direction) < std::cos(PathWalker::sharp_angle);
    }

    // Newton's method begins on the other side of the corner, `into` ahead and from there along `direction`,
    // `length` in all.
    bool step_beyond(double length, double into, const PathState &direction) {
        const PathState before = walker_.now(), old_tangent = walker_.tangent();
        PathState next = predict(into);
        add(length - into * walker_.cosine_with_tangent(direction), direction, next);
        const NewtonOutcome out = walker_.correct(next, direction, across_damping, false);
        const double moved = out.converged ? walker_.metric().distance(next, before) : 0;
        if (!is_near(out, moved, length)) return false;
        walker_.move(std::move(next));
        walker_.linearize_at_solution();
        walker_.make_tangent(nullptr);
        walker_.orient(out_.orientation);
        if (walker_.cosine_with_tangent(direction) > beyond_corner &&
            accept(out, moved, old_tangent, before)) {
            out_.last_step = 0;
            walker_.set_factored(false);
            out_.step = length;
            return true;
        }
        walker_.move(before);
        walker_.set_tangent(old_tangent);
        return false;
    }

    // A solution just beyond, found by the owner's own means; accepted only if it stays close.
    bool rescue() {
        out_.rescued = true;
        ++out_.n_rescues;
        const double side = walker_.tangent().parameter < 0 ? -1 : 1;
        for (double ahead : rescue_distances) {
            PathState next = walker_.now();
            next.parameter += side * ahead * walker_.metric().width;
            const bool found = owner_.rescue(next.parameter, next.x);
            const double moved = walker_.metric().distance(next, walker_.now());
            if (!found || moved > options_.max_step) continue;
            const PathState old_tangent = walker_.tangent();
            out_.arclength += moved;
            walker_.move(std::move(next));
            walker_.linearize_here();
            walker_.make_tangent(&old_tangent);
            out_.orientation = walker_.orientation();
            out_.last_step = 0;
            out_.tests = walker_.tests();
            record(0.0, 0, bifurcation::none);
            return true;
        }
        return false;
    }

    void record(double residual, std::int64_t iterations, std::int32_t bifurcation) {
        ++out_.n_recorded;
        const PathState &now = walker_.now();
        owner_.record({now.x, now.parameter, out_.arclength, residual, iterations, bifurcation});
    }

    PathWalker walker_;
    const PathOptions &options_;
    PathOwner &owner_;
    PathReturn back_;
    bool interrupted_ = false;
    double way_; // to a change of the owner's test functions, as far as it is in sight
    // Whether the step goes where the neighbouring path shows, and whether the last one that did failed.
    bool foreseen_ = false, astray_ = false;
    PathOutcome out_; // so far
};

} // namespace

PathOutcome follow_path(Residual &system, const PathOptions &options, const PathStart &start,
                        PathOwner &owner) {
    return Continuation(system, options, owner).run(start);
}

PathOutcome go_on_with_path(Residual &system, const PathOptions &options, const PathProgress &from,
                            PathOwner &owner) {
    return Continuation(system, options, owner).run(from);
}

} // namespace plm
