#include "paths/path_return.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t least_points_of_loop = 6; // before: the path is still on its way from the start
constexpr double passing_distance = 0.2;         // of the step, from its chord to the start it passes

} // namespace

void PathReturn::begin(const PathState &target, const PathState &tangent, bool from_start) {
    target_ = target;
    target_tangent_ = tangent;
    from_start_ = from_start;
}

void PathReturn::go_on(const PathProgress &from) {
    begin(from.target, from.target_direction, from.closes_at_start);
    passed_.take(from.passed);
}

void PathReturn::put(PathProgress &to) const {
    to.target = target_;
    to.target_direction = target_tangent_;
    to.closes_at_start = from_start_;
    to.passed = passed_.numbers();
}

bool PathReturn::is_target(const PathState &at) const {
    return walker_.metric().distance(at, target_) < same_solution;
}

std::int32_t PathReturn::by_step(const PathState &before, double moved, std::int64_t n_recorded) {
    if (!passes_target(before, moved, n_recorded))
        return goes_round(before) ? reason::crossed_over : reason::none;
    if (walker_.cosine_with_tangent(target_tangent_) > 0) return reason::loop_closed;
    PathState at;
    const bool turned = solve_on_step(before, target_.parameter, at) && is_target(at);
    return turned ? reason::turned_back : reason::none;
}

// The step from `before` passed the point where the path is closed.
bool PathReturn::passes_target(const PathState &before, double moved, std::int64_t n_recorded) const {
    if (from_start_ && n_recorded < least_points_of_loop) return false;
    const PathState chord = difference(walker_.now(), before), back = difference(target_, before);
    const double along = walker_.metric().product(chord, back) / (moved * moved);
    if (!(along > 0 && along <= 1)) return false;
    const double distance = walker_.metric().length(back);
    return std::sqrt(std::max(0.0, distance * distance - along * along * moved * moved)) <
           passing_distance * moved;
}

// The solution on the present step at a parameter.
bool PathReturn::solve_on_step(const PathState &before, double parameter, PathState &at) {
    const PathState chord = difference(walker_.now(), before);
    const double part = chord.parameter != 0 ? (parameter - before.parameter) / chord.parameter : 1;
    at = before;
    add(part, chord, at);
    at.parameter = parameter;
    const bool found = walker_.correct_at_parameter(at).converged;
    walker_.linearize_here();
    return found;
}

// The step from `before` came by a point of the path.
bool PathReturn::goes_round(const PathState &before) {
    const std::int64_t k = passed_.on_step(walker_.metric(), before, walker_.now(), walker_.tangent());
    PathState at;
    return k >= 0 && solve_on_step(before, passed_.parameter(k), at) && passed_.is(k, walker_.metric(), at);
}

} // namespace plm
