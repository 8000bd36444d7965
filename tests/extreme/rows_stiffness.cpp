// Contact stiffness from 1e-3 to 1e9 times the local stiffness of the structure.
#include "row.hpp"
#include "structures.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace extreme {
namespace {

enum class Rest { zero_gap, gap, preload };

// Four masses with a stop at the end. Damping of 10 % in the first mode: the marched exact flow has a stable motion
// of the forcing period at every frequency of 0.5 to 0.9 for any stiffness, so there is a regular curve to find.
exact::Structure one_stop(Rest rest, double ratio) {
    exact::Structure s = chain(4, 0.1, {3});
    set_contact(s, ratio * local_stiffness(s), rest == Rest::gap ? 1.0 : 0.0);
    if (rest == Rest::preload) s.preload[3] = 0.1;
    return s;
}

// The same with a second pair inside the chain, 2 % damping, and a force that opens and closes both.
exact::Structure two_pairs(Rest rest, double ratio) {
    exact::Structure s = chain(4, 0.02, {1, 3});
    set_contact(s, ratio * local_stiffness(s), rest == Rest::gap ? 2.0 : 0.0);
    if (rest == Rest::preload) s.preload[3] = 2.0;
    return s;
}

// The exact flow takes steps of a fifth of the shortest contact, so that it misses none.
int samples_for(double ratio) {
    return std::max(2000, static_cast<int>(16 * std::sqrt(ratio)));
}

Measured sweep(const exact::Structure &s, double low, double ratio, bool sampled) {
    Setup setup;
    setup.low = low, setup.high = 0.9;
    setup.sampled = sampled;
    Solver solver(s, setup);
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    m.error = orbit_error(s, *curve, ratio > 1e6 ? 4 : 6, samples_for(ratio));
    return m;
}

using Build = exact::Structure (*)(Rest rest, double ratio);

Row row_of(const char *scene, Build build, Rest rest, const char *word, int power, double low) {
    char name[64], parameters[128];
    std::snprintf(name, sizeof name, "stiffness-%s-%s-1e%d", scene, word, power);
    std::snprintf(parameters, sizeof parameters, "4 masses, %s, %s, k_n = 1e%d k_loc", scene, word, power);
    const double ratio = std::pow(10.0, power);
    // Soft contact: what harmonic_tolerance leaves. Stiff: impacts, velocities jump and errors fall as H^-2.
    return {name, parameters, "exact orbits", power <= 1 ? 1e-3 : 1e-2, power <= 5,
            [=](bool sampled) { return sweep(build(rest, ratio), low, ratio, sampled); }};
}

} // namespace

std::vector<Row> stiffness_rows() {
    std::vector<Row> rows;
    const std::pair<Rest, const char *> cases[] = {
        {Rest::zero_gap, "zero-gap"}, {Rest::gap, "gap"}, {Rest::preload, "pre-load"}};
    for (const auto &[rest, word] : cases) {
        for (int power = -3; power <= 9; power += 2)
            rows.push_back(row_of("one-stop", one_stop, rest, word, power, power <= 1 ? 0.3 : 0.5));
        for (int power = -3; power <= 1; power += 2)
            rows.push_back(row_of("two-pairs", two_pairs, rest, word, power, 0.3));
    }
    return rows;
}

} // namespace extreme
