#include "paths/step_length.hpp"
#include "paths/path_walker.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// The length of a step. It decides how many points a path takes; what may not be stepped over is asked for by
// accept().
constexpr double target_angle = 0.25; // rad between neighbouring tangents
constexpr double straight = 1e-6;     // rad: hardly turned, the angle itself is rounding
constexpr double most_growth = 1.6,
                 least_growth = 0.35;       // from one step to the next: the curvature varies, too
constexpr std::int64_t many_iterations = 6; // with more than one tangent: the prediction was poor
constexpr double slow_growth = 0.6;         // then, however straight the path is

// Where a test function of the owner comes nearer to zero, the next step goes just beyond the zero as it is
// to be expected from the last step, so that a function that dips below zero for a short while is not stepped
// over; but no less than a part of the largest step, since many a function comes near and turns.
constexpr double just_beyond = 1.2, least_beside_change = 0.1;

} // namespace

double step_growth(double angle, const NewtonOutcome &out) {
    const double factor =
        std::min(most_growth, std::max(least_growth, target_angle / std::max(angle, straight)));
    const bool poor = out.iterations > many_iterations && out.factorizations > 1;
    return poor ? std::min(factor, slow_growth) : factor;
}

double way_to_change(const vector<double> &old_tests, const vector<double> &tests, double moved,
                     double max_step) {
    double way = max_step;
    for (std::size_t k = PathWalker::own_tests; k < std::min(tests.size(), old_tests.size()); ++k) {
        const double before = std::abs(old_tests[k]), now = std::abs(tests[k]);
        if (!(tests[k] * old_tests[k] > 0 && now < before)) continue;
        way = std::min(way, just_beyond * moved * now / (before - now));
    }
    return std::max(way, least_beside_change * max_step);
}

} // namespace plm
