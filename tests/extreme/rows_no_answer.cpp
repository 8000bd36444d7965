// Cases without an answer: the library has to say why.
#include "row.hpp"
#include "structures.hpp"
#include <algorithm>
#include <cstdio>

namespace extreme {
namespace {

Measured thrown(const exact::Structure &s, const Setup &setup) {
    Solver solver(s, setup);
    return outcome_of(*solver.sweep());
}

// A mass on nothing but a stop, pulled away from it.
Measured pulled_away(bool) {
    exact::Structure s = empty(1, 1);
    s.gap_rows = {1};
    s.damping = {0.1};
    s.force = {0.1};
    s.preload = {-1};
    Setup setup;
    setup.low = 0.5, setup.high = 1.5;
    return thrown(s, setup);
}

// A free mass that is not held by anything at all, pushed: no stop ahead of it either.
Measured pushed_sideways(bool) {
    exact::Structure s = empty(2, 1);
    add_spring(s, 0, -1, 1, 0.1);
    s.gap_rows = {1, 0};
    s.force = {0.1, 0};
    s.preload = {0, 1};
    Setup setup;
    setup.low = 0.5, setup.high = 1.5;
    return thrown(s, setup);
}

// Driven at the resonance of an undamped oscillator that no contact ever reaches.
Measured undamped_resonance(bool) {
    exact::Structure s = empty(2, 1);
    add_spring(s, 0, -1, 1, 0);
    add_spring(s, 1, -1, 2, 0.1);
    s.gap_rows = {0, 1};
    s.force = {1, 0.1};
    Setup setup;
    setup.low = 0.5, setup.high = 1.5;
    Solver solver(s, setup);
    return outcome_of(*solver.solve(1.0));
}

// An undamped oscillator with a stop at its rest position, swept down through 2 w1 w2 / (w1 + w2): the
// amplitude grows without bound, and the curve never leaves the range.
Measured unbounded(bool sampled) {
    Setup setup;
    setup.low = 0.5, setup.high = 3;
    setup.sampled = sampled;
    Solver solver(oscillator(0, 3, 0, 1, 0), setup);
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    const std::vector<double> a = curve->amplitude(0);
    char text[64];
    std::snprintf(text, sizeof text, ", at amplitude %.0e", *std::max_element(a.begin(), a.end()));
    m.outcome += text;
    return m;
}

} // namespace

std::vector<Row> no_answer_rows() {
    std::vector<Row> rows;
    rows.push_back({"no-answer-pulled-away", "a mass on nothing but a stop, pulled away from it", "reason", 0,
                    true, pulled_away, false, PLM_REASON_NO_EQUILIBRIUM});
    rows.push_back({"no-answer-pushed", "a mass held by nothing, pushed", "reason", 0, true, pushed_sideways,
                    false, PLM_REASON_NO_EQUILIBRIUM});
    rows.push_back({"no-answer-resonance", "no damping, driven at a resonance that no stop limits", "reason",
                    0, true, undamped_resonance, false, PLM_REASON_SINGULAR});
    rows.push_back({"no-answer-unbounded", "no damping, through the resonance with a stop without gap",
                    "reason", 0, true, unbounded, false, PLM_REASON_STEP_MINIMUM});
    return rows;
}

} // namespace extreme
