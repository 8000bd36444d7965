#include "motions/peak_search.hpp"
#include "motions/branch_path.hpp"
#include "motions/error_budget.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {
namespace {

constexpr double least_tolerance = 1e-12; // rounding of a period of the flow

} // namespace

bool PeakSearch::run(const Branch &branch, const std::array<std::int64_t, 3> &around, BranchPoint &highest) {
    for (int k = 0; k < 3; ++k) load(branch, around[k], three_[k]);
    of_curve_ = three_;
    set_chord();
    if (!is_exact() && !solve_triple()) {
        above_ = rise();
        return false;
    }
    const bool settled = close_in();
    const Sample &top = *std::max_element(
        three_.begin(), three_.end(), [](const auto &a, const auto &b) { return a.amplitude < b.amplitude; });
    constexpr double same_height = 1e-9; // rounding decides between them
    Sample best;
    const double rises = settled ? 0 : rise();
    if (!corrected(vertex(), best) || best.amplitude < top.amplitude * (1 - same_height)) best = top;
    const double above = std::max(0.0, rises - (best.amplitude / top.amplitude - 1));
    above_ = settled ? above : climb(best, above);
    highest = std::move(best.point);
    return true;
}

// Where contact begins the curve may turn at a corner, and no chord leads there: on in frequency, away from
// the nearest lower point of the curve, in steps that are halved where the motion is lost or gains less.
double PeakSearch::climb(Sample &best, double above) {
    const double enough = ErrorBudget(options_.accuracy).corner();
    constexpr double as_before = 0.7; // less is gained beyond the corner
    constexpr int most_solved = 40;
    const auto far = [&](const Sample &s) {
        const double length = metric_.length(difference(best.at, s.at));
        return s.amplitude < best.amplitude ? length : INFINITY;
    };
    Sample before = *std::min_element(of_curve_.begin(), of_curve_.end(),
                                      [&](const auto &a, const auto &b) { return far(a) < far(b); });
    if (std::isinf(far(before)) || before.at.parameter == best.at.parameter) return above;
    chord_ = {vector<double>(best.at.x.size(), 0.0), 1.0};
    scale_by(1 / metric_.length(chord_), chord_);
    double step = 1, beyond = INFINITY; // step: of that from before to best; beyond: where less was gained
    const auto rises = [&] {            // where nothing was solved beyond: as much again as by the last step
        const double gained = 1 - before.amplitude / best.amplitude,
                     last = std::abs(best.at.parameter - before.at.parameter);
        return std::isinf(beyond) ? gained : gained * std::abs(beyond - best.at.parameter) / last;
    };
    for (int k = 0; k < most_solved && step * rises() > enough; ++k) {
        Sample next = best;
        add(step, difference(best.at, before.at), next.at);
        const double expected = step * (best.amplitude - before.amplitude);
        const bool found = solved(next);
        if (found && next.amplitude - best.amplitude > as_before * expected) {
            before = std::exchange(best, std::move(next));
            step = 1;
        } else {
            if (found) beyond = next.at.parameter;
            step *= 0.5;
        }
    }
    return std::max(above, rises());
}

bool PeakSearch::is_exact() const {
    return std::all_of(three_.begin(), three_.end(), [](const Sample &s) { return s.point.motion; });
}

// The curve's points may have other numbers of harmonics; a parabola through both kinds has no meaning.
bool PeakSearch::solve_triple() {
    Sample solved, left, right;
    if (!corrected(three_[1].s, solved)) return false;
    const bool all = corrected(three_[0].s, left) && corrected(three_[2].s, right);
    three_[1] = solved;
    if (all) three_[0] = left, three_[2] = right;
    return true;
}

// New triples around the vertex, ten times closer as long as the top is inside: the error of a parabola
// falls with its square. One that misses the top (far from it the curve is no parabola) goes to its
// higher side with wider steps.
bool PeakSearch::close_in() {
    // Closer, differences of amplitudes drown in the error of their solutions, which corrected() keeps
    // small; and where contact forces come from samples, in the jumps as a pair switches past one.
    constexpr double usual = 1e-9, close = 2e-3; // the height of a parabola goes with the square
    const double closest = (jumps_ ? 5e-2
                                   : std::clamp(close * std::sqrt(options_.tolerance / usual), close, 5e-2)) *
                           span_,
                 widest = 0.25 * span_;
    constexpr int most_rounds = 20; // three when the top is inside from the beginning
    double reach = 0.05 * span_;
    for (int round = 0; round < most_rounds; ++round) {
        Sample left, middle, right;
        if (!corrected(vertex(), middle) || !corrected(middle.s - reach, left) ||
            !corrected(middle.s + reach, right))
            return false;
        three_ = {left, middle, right};
        const bool inside = left.amplitude < middle.amplitude && right.amplitude < middle.amplitude;
        if (inside && reach <= closest) return true;
        reach = inside ? std::max(0.1 * reach, closest) : std::min(2 * reach, widest);
    }
    return false;
}

// Of the parabola above the highest of the three, relative.
double PeakSearch::rise() const {
    const double s = vertex();
    double height = 0, top = 0;
    for (int k = 0; k < 3; ++k) {
        const Sample &a = three_[k], &b = three_[(k + 1) % 3], &c = three_[(k + 2) % 3];
        height += a.amplitude * (s - b.s) * (s - c.s) / ((a.s - b.s) * (a.s - c.s));
        top = std::max(top, a.amplitude);
    }
    return top > 0 ? std::max(0.0, height / top - 1) : 0;
}

void PeakSearch::load(const Branch &branch, std::int64_t i, Sample &s) {
    s.point = branch.points()[i];
    s.at = {equations_.unknowns(s.point), s.point.omega};
    s.amplitude = branch.amplitude(i, of_.dof, of_.measure, of_.harmonic);
}

void PeakSearch::set_chord() {
    const double size = norm2(equations_.size(), three_[1].at.x.data());
    metric_ = {size > 0 ? size : 1, 2 * M_PI * (options_.frequency_max_hz - options_.frequency_min_hz)};
    chord_ = difference(three_[2].at, three_[0].at);
    scale_by(1 / metric_.length(chord_), chord_);
    origin_ = three_[1].at;
    for (Sample &s : three_) s.s = metric_.product(chord_, difference(s.at, origin_));
    first_ = three_[0].s, last_ = three_[2].s;
    span_ = last_ - first_;
}

// Vertex of the parabola through the triple, kept inside it and inside the first one.
double PeakSearch::vertex() const {
    const Sample &a = three_[0], &b = three_[1], &c = three_[2];
    const double left = (b.amplitude - a.amplitude) / (b.s - a.s),
                 right = (c.amplitude - b.amplitude) / (c.s - b.s);
    const double bend = (right - left) / (c.s - a.s);
    double s = 0.5 * (a.s + b.s) - 0.5 * left / bend;
    if (!(bend < 0))
        s = std::max({a.amplitude, b.amplitude, c.amplitude}) == b.amplitude ? b.s
            : a.amplitude > c.amplitude                                      ? a.s
                                                                             : c.s;
    return std::clamp(s, std::max(a.s, first_), std::min(c.s, last_));
}

// The curve's point in the hyperplane at s, from the parabola through the triple as first guess.
bool PeakSearch::corrected(double s, Sample &out) {
    watch_.step("peak", 0.5);
    const Sample &a = three_[0], &b = three_[1], &c = three_[2];
    const double la = (s - b.s) * (s - c.s) / ((a.s - b.s) * (a.s - c.s)),
                 lb = (s - a.s) * (s - c.s) / ((b.s - a.s) * (b.s - c.s)),
                 lc = (s - a.s) * (s - b.s) / ((c.s - a.s) * (c.s - b.s));
    out.at = a.at;
    scale_by(la, out.at);
    add(lb, b.at, out.at);
    add(lc, c.at, out.at);
    out.s = s;
    return solved(out);
}

// From its first guess, across the chord.
bool PeakSearch::solved(Sample &out) {
    NewtonLimits limits = newton_limits(options_);
    limits.aim = std::max(1e-3 * limits.tolerance, least_tolerance); // for small differences
    const NewtonOutcome found = newton_across(equations_, metric_, chord_, limits, out.at);
    if (!found.converged) return false;
    out.point = equations_.solved_point(out.at, found.residual, found.iterations);
    Branch one(reduced_, options_.force_scale, options_.period_multiple);
    one.append(out.point);
    out.amplitude = one.amplitude(0, of_.dof, of_.measure, of_.harmonic);
    return true;
}

} // namespace plm
