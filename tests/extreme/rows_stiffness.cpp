// Contact stiffness from 1e-3 to 1e9 times the local stiffness of the structure.
#include "row.hpp"
#include "structures.hpp"
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace extreme {
namespace {

enum class Rest { zero_gap, gap, preload };

// Four masses, a pair inside the chain and one against the ground. Linear resonance amplitude of the end: about 21.
exact::Structure scene_of(Rest rest, double ratio) {
    exact::Structure s = chain(4, std::getenv("Z") ? std::atof(std::getenv("Z")) : 0.02, {1, 3});
    const double k = ratio * local_stiffness(s);
    set_contact(s, k, rest == Rest::gap ? 2.0 : 0.0);
    if (rest == Rest::preload) s.preload[3] = 2.0; // lifts off around the resonance
    return s;
}

Measured sweep(Rest rest, double ratio, int harmonics, int samples, bool sampled) {
    const exact::Structure s = scene_of(rest, ratio);
    Setup setup;
    setup.low = 0.3, setup.high = 0.9;
    setup.harmonics = harmonics;
    setup.sampled = sampled;
    Solver solver(s, setup);
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    m.error = orbit_error(s, *curve, 3, 6, samples);
    return m;
}

} // namespace

std::vector<Row> stiffness_rows() {
    std::vector<Row> rows;
    const std::pair<Rest, const char *> cases[] = {
        {Rest::zero_gap, "zero-gap"}, {Rest::gap, "gap"}, {Rest::preload, "pre-load"}};
    for (const auto &[rest, word] : cases)
        for (int power = -3; power <= 9; power += 2) {
            char name[64], parameters[128];
            const int harmonics = std::getenv("HH") ? std::atoi(std::getenv("HH")) : 0;
            std::snprintf(name, sizeof name, "stiffness-%s-1e%d", word, power);
            std::snprintf(parameters, sizeof parameters, "4 masses, 2 pairs, %s, k_n = 1e%d k_loc, H = %d", word,
                          power, harmonics);
            const Rest r = rest;
            const int samples = power <= 3 ? 2000 : power <= 5 ? 10000 : 60000;
            rows.push_back({name, parameters, "exact orbits", 1e-2, power <= 3, [=](bool sampled) {
                                return sweep(r, std::pow(10.0, power), harmonics, samples, sampled);
                            }});
        }
    return rows;
}

} // namespace extreme
