#include "paths/special_points.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace plm {
namespace {

// Where a zero is looked for in an interval when the test function has no value at the best place.
constexpr std::array<double, 5> elsewhere = {0.5, 0.75, 0.25, 0.9, 0.1};
constexpr double vanishes = 1e-9; // of the smaller value at the ends: found
// At the end of the search: the function is continuous there. Where two special points stand side by side, as
// on structures with pairs of equal modes, the points of the path between them are no more exact than that; a
// jump leaves the function at its size on both sides.
constexpr double nearly_vanishes = 1e-2;
constexpr int most_places = 60;     // more than bisection needs to the narrowest interval
constexpr double narrowest = 1e-10; // interval, of the step: what is left is rounding
constexpr double same_place = 1e-7; // of the step, or what solutions are off by: another look tells nothing
// A function that has not become smaller than this on either side of so narrow an interval jumps; one that
// begins with a root has.
constexpr double jump_width = 1e-4, jump_size = 0.1;
// So does a test of the owner that is as large as at the ends of the step close to both sides.
constexpr double flat = 0.9, flat_width = 0.05;
constexpr double off_the_ends =
    1e-3; // of the interval: places where the function is known need no second look
// What a point is off by grows with the lens where it foretells another, farther from the ends.
constexpr double most_magnified = 4;
constexpr double least_damping = 1e-3; // between two known points Newton's method may take its time
// How far the ends of an interval may lie apart, as a multiple of its part of the step, on one continuous
// curve.
constexpr double most_stretched = 20;
constexpr double corner_width = 1e-3; // of the step: closer ends enclose a corner, farther ones a jump

double value_of(const vector<double> &tests, std::size_t k) {
    return k < tests.size() ? tests[k] : 0;
}

// Where a function changes its sign: inverse quadratic interpolation where its last three values allow that,
// bisection elsewhere (Chandrupatla, Adv. Eng. Software 28, 1997).
class Enclosure {
  public:
    Enclosure(double left, double right) : last_{0, left}, other_{1, right}, before_(last_) {
        first_[left > 0] = left;
        first_[right > 0] = right;
    }

    double width() const { return std::abs(last_.t - other_.t); }
    /// Both ends have come nearer, and the function has not become smaller at either: it jumps in between.
    bool is_flat() const {
        return moved_[0] && moved_[1] && std::abs(last_.value) > flat * std::abs(first_[last_.value > 0]) &&
               std::abs(other_.value) > flat * std::abs(first_[other_.value > 0]);
    }
    double smaller() const { return std::min(std::abs(last_.value), std::abs(other_.value)); }
    double last() const { return last_.t; }
    double at_part(double part) const { return last_.t + part * (other_.t - last_.t); }
    bool is_settled(double within) const {
        return known_ > 0 && interpolates() && std::abs(next() - last_.t) < within;
    }

    double next() const {
        if (known_ == 0) return at_part(last_.value / (last_.value - other_.value));
        return interpolates() ? at_part(quadratic()) : at_part(0.5);
    }

    // True: in place of the lower end.
    bool take(double t, double value) {
        const bool keeps = (value > 0) == (last_.value > 0);
        moved_[value > 0] = true;
        before_ = keeps ? last_ : other_;
        if (!keeps) other_ = last_;
        last_ = {t, value};
        ++known_;
        return t < other_.t;
    }

  private:
    struct Place {
        double t, value;
    };

    bool interpolates() const {
        const double place = (last_.t - other_.t) / (before_.t - other_.t),
                     size = (last_.value - other_.value) / (before_.value - other_.value);
        return size * size < place && (1 - size) * (1 - size) < 1 - place;
    }
    double quadratic() const {
        const double f1 = last_.value, f2 = other_.value, f3 = before_.value;
        return f1 / (f2 - f1) * f3 / (f2 - f3) +
               (before_.t - last_.t) / (other_.t - last_.t) * f1 / (f3 - f1) * f2 / (f3 - f2);
    }

    Place last_, other_, before_;      // the first two enclose the zero
    std::array<double, 2> first_ = {}; // of the values, negative and positive
    std::array<bool, 2> moved_ = {};
    int known_ = 0;
};

class Finder {
  public:
    Finder(PathWalker &walker, const PathOptions &options, const PathStep &step, double orientation)
        : walker_(walker), options_(options), step_(step), orientation_(orientation),
          chord_(difference(step.after, step.before)) {}

    // False when the function jumps instead of vanishing (but for a corner at which p turns round); the step
    // then may have crossed to another curve.
    bool find_zero(std::size_t k, double left, double right, SpecialPoint &point) {
        const double size = std::min(std::abs(left), std::abs(right));
        const bool is_fold = walker_.kind(k) == bifurcation::fold;
        Enclosure zero(left, right);
        const double settled = std::max(same_place, options_.tolerance);
        double best = INFINITY;
        std::size_t unknown = 0; // times in a row that the function had no value (stability at a fold)
        PathState below = step_.before, above = step_.after;
        for (int i = 0; i < most_places && zero.width() > narrowest && !zero.is_settled(settled); ++i) {
            const double part = (zero.next() - zero.last()) / (zero.at_part(1) - zero.last());
            const double t = zero.at_part(unknown > 0 ? elsewhere[unknown - 1]
                                                      : std::clamp(part, off_the_ends, 1 - off_the_ends));
            double residual = 0;
            if (!move_to(t, residual)) break;
            const double value = walker_.test(k);
            if (std::isnan(value) && ++unknown > elsewhere.size()) break;
            if (std::isnan(value)) continue;
            unknown = 0;
            if (std::abs(value) < best) {
                best = std::abs(value);
                point = {t, walker_.now(), walker_.kind(k), residual};
            }
            if (best <= vanishes * size) break;
            (zero.take(t, value) ? below : above) = walker_.now();
            if (!is_fold && zero.width() < jump_width && zero.smaller() > jump_size * size) break;
            if (k >= PathWalker::own_tests && zero.width() < flat_width && zero.is_flat()) break;
            // what is left is no continuous piece of a curve
            if (walker_.metric().distance(below, above) > most_stretched * zero.width() * step_.length) break;
        }
        if (std::isfinite(best) && best <= nearly_vanishes * size) return true;
        if (is_fold && is_corner_fold(below, above, point)) return true;
        jumped_ = jumped_ || walker_.kind(k) == bifurcation::branch_point;
        return false;
    }

    bool jumped() const { return jumped_; }

  private:
    // Cubic through both ends with their tangents.
    PathState between(double t) const {
        const double b = t * t * (3 - 2 * t), a = 1 - b, da = step_.length * t * (1 - t) * (1 - t),
                     db = step_.length * t * t * (t - 1);
        PathState p = step_.before;
        scale_by(a, p);
        add(b, step_.after, p);
        add(da, step_.tangent_before, p);
        add(db, step_.tangent_after, p);
        return p;
    }
    // How the distance of the path from that cubic goes along the step, to the lowest order.
    static double lens(double t) { return t * t * (1 - t) * (1 - t); }

    // The point of the path at t of the way becomes the present one.
    bool move_to(double t, double &residual) {
        PathState p = between(t);
        if (lens(t) < most_magnified * lens_) add(lens(t) / lens_, beside_, p);
        const NewtonOutcome out = walker_.correct(p, chord_, least_damping, false);
        if (!out.converged) return false;
        residual = out.residual;
        beside_ = difference(p, between(t));
        lens_ = lens(t);
        walker_.move(std::move(p));
        if (out.factored_away < PathWalker::at_the_point * step_.length)
            walker_.stand();
        else
            walker_.linearize_at_solution();
        walker_.make_tangent(&step_.tangent_before);
        if (walker_.metric().product(step_.tangent_before, step_.tangent_after) <
            std::cos(PathWalker::sharp_angle))
            walker_.orient(orientation_);
        return true;
    }

    // Where contact begins or, with sampled forces, at the switching of a sample the path has a corner: p
    // turns round there without its derivative passing zero. `below` and `above` enclose the zero of the
    // fold's test.
    bool is_corner_fold(const PathState &below, const PathState &above, SpecialPoint &point) const {
        if (walker_.metric().distance(below, above) >
            std::max(corner_width * step_.length, options_.min_step))
            return false; // a jump
        const double up = step_.tangent_before.parameter > 0 ? 1 : -1;
        point.at = up * below.parameter > up * above.parameter ? below : above;
        return true;
    }

    PathWalker &walker_;
    const PathOptions &options_;
    const PathStep &step_;
    double orientation_;
    PathState chord_, beside_; // beside_: of the last point found, from the cubic
    double lens_ = 0;          // there; 0: none was found
    bool jumped_ = false;
};

} // namespace

bool any_special_points(const vector<double> &tests_before, const vector<double> &tests_after) {
    for (std::size_t k = 0; k < tests_before.size(); ++k)
        if (tests_before[k] * value_of(tests_after, k) < 0) return true;
    return false;
}

SpecialPoints find_special_points(PathWalker &walker, const PathOptions &options, const PathStep &step,
                                  double orientation, const vector<double> &tests_before,
                                  const vector<double> &tests_after) {
    SpecialPoints all;
    Finder finder(walker, options, step, orientation);
    for (std::size_t k = 0; k < walker.n_tests(); ++k) {
        const double left = value_of(tests_before, k), right = value_of(tests_after, k);
        SpecialPoint point;
        if (left * right < 0 && finder.find_zero(k, left, right, point))
            all.found.push_back(std::move(point));
    }
    all.jumped = finder.jumped();
    std::sort(all.found.begin(), all.found.end(),
              [](const SpecialPoint &a, const SpecialPoint &b) { return a.position < b.position; });
    return all;
}

} // namespace plm
