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
constexpr int bisection_every = 4;  // so that a function that bends hard is enclosed all the same
constexpr double off_the_ends =
    1e-3; // of the interval: places where the function is known need no second look
constexpr double least_damping = 1e-3; // between two known points Newton's method may take its time
// How far the ends of an interval may lie apart, as a multiple of its part of the step, on one continuous
// curve.
constexpr double most_stretched = 20;
constexpr double corner_width = 1e-3; // of the step: closer ends enclose a corner, farther ones a jump

double value_of(const vector<double> &tests, std::size_t k) {
    return k < tests.size() ? tests[k] : 0;
}

class Finder {
  public:
    Finder(PathWalker &walker, const PathOptions &options, const PathStep &step, double orientation)
        : walker_(walker), options_(options), step_(step), orientation_(orientation),
          chord_(difference(step.after, step.before)) {}

    // Regula falsi (Illinois) with bisection on the chord. False when the function jumps instead of
    // vanishing (but for a corner at which p turns round); the step then may have crossed to another curve.
    bool find_zero(std::size_t k, double left, double right, SpecialPoint &point) {
        const double size = std::min(std::abs(left), std::abs(right));
        double a = 0, b = 1, best = INFINITY;
        int last_side = 0;
        std::size_t unknown = 0; // times in a row that the function had no value (stability at a fold)
        PathState below = step_.before, above = step_.after;
        for (int i = 0; i < most_places && b - a > narrowest; ++i) {
            double t = i % bisection_every == bisection_every - 1 ? 0.5 * (a + b)
                                                                  : (a * right - b * left) / (right - left);
            if (unknown > 0) t = a + elsewhere[unknown - 1] * (b - a);
            t = std::min(b - off_the_ends * (b - a), std::max(a + off_the_ends * (b - a), t));
            double residual = 0;
            if (!move_to(t, residual)) break;
            const double value = value_of(walker_.tests(), k);
            if (std::isnan(value) && ++unknown > elsewhere.size()) break;
            if (std::isnan(value)) continue;
            unknown = 0;
            if (std::abs(value) < best) {
                best = std::abs(value);
                point = {t, walker_.now(), walker_.kind(k), residual};
            }
            if (best <= vanishes * size) break;
            const bool keeps_left = value * left > 0;
            if (keeps_left) {
                if (last_side == 1) right *= 0.5;
                a = t, left = value, last_side = 1, below = walker_.now();
            } else {
                if (last_side == -1) left *= 0.5;
                b = t, right = value, last_side = -1, above = walker_.now();
            }
            // what is left is no continuous piece of a curve
            if (walker_.metric().distance(below, above) > most_stretched * (b - a) * step_.length) break;
        }
        if (std::isfinite(best) && best <= nearly_vanishes * size) return true;
        if (walker_.kind(k) == PLM_BIFURCATION_FOLD && is_corner_fold(below, above, point)) return true;
        jumped_ = jumped_ || walker_.kind(k) == PLM_BIFURCATION_BRANCH_POINT;
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

    // The point of the path at t of the way becomes the present one.
    bool move_to(double t, double &residual) {
        PathState p = between(t);
        const NewtonOutcome out = walker_.correct(p, chord_, least_damping, false);
        if (!out.converged) return false;
        residual = out.residual;
        walker_.move(std::move(p));
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
    PathState chord_;
    bool jumped_ = false;
};

} // namespace

SpecialPoints find_special_points(PathWalker &walker, const PathOptions &options, const PathStep &step,
                                  double orientation, const vector<double> &tests_before,
                                  const vector<double> &tests_after) {
    SpecialPoints all;
    if (!options.locate) return all;
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
