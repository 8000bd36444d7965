// Contact stiffness from 1e-3 to 1e9 times the local stiffness of the structure.
#include "row.hpp"
#include "structures.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace extreme {
namespace {

enum class Rest { zero_gap, gap, preload };

// Four masses with a stop at the end. Damping of 10 %: less of it, and the second pair, leave hardly a
// frequency with a stable motion of the forcing period in stiff contact (2 %, two pairs, no gap, 1e3: none of
// 31). Marched exactly at 13 frequencies of 0.5 to 0.9, k_n = 1e3 and 1e5 k_loc: without a gap all end in a
// motion of that period, with a gap 13 and 8, pre-loaded 12 and 11. Where they do not, the curve is unstable
// or another motion stands beside it.
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

// The stop stands on a DOF without mass behind a spring of stiffness 2: no impacts however stiff the contact
// is. The exact flow has the two springs in series as one.
struct Bedded {
    exact::Structure structure, truth;
    std::vector<double> mass;
};

Bedded bedded(Rest rest, double ratio) {
    Bedded b{empty(5, 1), chain(4, 0.02, {3}), std::vector<double>(25, 0.0)};
    exact::Structure &s = b.structure;
    for (int i = 0; i < 4; ++i) {
        add_spring(s, i, i - 1, 1, b.truth.damping[15]); // of one spring
        b.mass[6 * i] = 1;
    }
    add_spring(s, 4, 3, 2, 0);
    s.gap_rows[4] = 1;
    s.force[3] = 1;
    s.preload[3] = b.truth.preload[3] = rest == Rest::preload ? 2.0 : 0.0;
    const double k = ratio * local_stiffness(s), gap = rest == Rest::gap ? 2.0 : 0.0;
    set_contact(s, k, gap);
    set_contact(b.truth, 1 / (1 / k + 1.0 / 2), gap);
    return b;
}

// Displacements have kinks at impacts: five samples in the shortest contact.
int samples_for(double ratio) {
    return std::max(2000, static_cast<int>(16 * std::sqrt(ratio)));
}

Measured sweep(Solver &solver, const exact::Structure &truth, int n_points, int samples) {
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    m.error = orbit_error(truth, *curve, n_points, samples);
    return m;
}

Setup range(double low, double high, bool sampled) {
    Setup setup;
    setup.low = low, setup.high = high;
    setup.sampled = sampled;
    return setup;
}

// From some points of the stiffest contact no exact orbit of the forcing period is found (see one_stop).
Measured against_impacts(exact::Structure (*build)(Rest, double), Rest rest, double ratio, bool sampled) {
    const exact::Structure s = build(rest, ratio);
    Solver solver(s, range(ratio > 100 ? 0.5 : 0.3, 0.9, sampled));
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    if (curve->end_reason != PLM_REASON_RANGE_END) return m; // seconds a point, for nothing
    const int n = 6;
    const OrbitErrors errors = orbit_errors(s, *curve, n, samples_for(ratio));
    m.error = 2 * errors.missing < n ? errors.worst : 1e300;
    if (errors.missing > 0)
        m.outcome += "; exact orbits at " + std::to_string(n - errors.missing) + " of " + std::to_string(n) +
                     " points";
    return m;
}

Measured against_series(Rest rest, double ratio, bool sampled) {
    const Bedded b = bedded(rest, ratio);
    Solver solver(b.structure, b.mass, range(0.3, 0.9, sampled));
    return sweep(solver, b.truth, 6, 2000);
}

struct Family {
    const char *name, *text;
    int highest; // power of ten
    Measured (*measure)(Rest rest, double ratio, bool sampled);
};

// Curves of exact motions are right to what the exact flow of the tests resolves: its orbits end at 1e-10,
// and beside a grazing touch the amplitude changes by much more than the state. The project promises 1e-4.
constexpr double bound = 1e-4;

// Truths of the stiffest impacts take a minute.
bool quick(const Family &family, int power) {
    return power <= 5 || family.name[0] == 'b';
}

Row row_of(const Family &family, Rest rest, const char *word, int power) {
    char name[64], parameters[128];
    std::snprintf(name, sizeof name, "stiffness-%s-%s-1e%d", family.name, word, power);
    std::snprintf(parameters, sizeof parameters, "%s, %s, k_n = 1e%d k_loc", family.text, word, power);
    const double ratio = std::pow(10.0, power);
    const auto measure = family.measure;
    return {name,  parameters,           "exact orbits",
            bound, quick(family, power), [=](bool sampled) { return measure(rest, ratio, sampled); }};
}

} // namespace

std::vector<Row> stiffness_rows() {
    std::vector<Row> rows;
    const std::pair<Rest, const char *> cases[] = {
        {Rest::zero_gap, "zero-gap"}, {Rest::gap, "gap"}, {Rest::preload, "pre-load"}};
    const Family families[] = {
        {"bed", "4 masses, stop on a mass-less DOF", 9, against_series},
        {"impact", "4 masses, stop on a mass, 10 % damping", 9,
         [](Rest r, double ratio, bool sampled) { return against_impacts(one_stop, r, ratio, sampled); }},
        {"pairs", "4 masses, 2 pairs, 2 % damping", 1,
         [](Rest r, double ratio, bool sampled) { return against_impacts(two_pairs, r, ratio, sampled); }}};
    for (const Family &family : families)
        for (const auto &[rest, word] : cases)
            for (int power = -3; power <= family.highest; power += 2)
                rows.push_back(row_of(family, rest, word, power));
    return rows;
}

} // namespace extreme
