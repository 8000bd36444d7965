// Structures at the edge: one pair and a thousand, rigid-body modes, mass-less DOFs, units, close resonances.
#include "dense.hpp"
#include "row.hpp"
#include "structures.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace extreme {
namespace {

Measured sweep_against(const exact::Structure &truth, Solver &solver, int samples) {
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    m.error = orbit_error(truth, *curve, 6, samples);
    return m;
}

Setup range(double low, double high, bool sampled) {
    Setup setup;
    setup.low = low, setup.high = high;
    setup.sampled = sampled;
    return setup;
}

// A rigid block (heave, pitch, roll) on soft mounts over a bed of 40 x 25 unilateral springs, pressed down.
Measured block_on_a_thousand_springs(bool sampled) {
    exact::Structure s = empty(3, 1000);
    const double stiffness[] = {1, 0.4, 0.3};
    for (int i = 0; i < 3; ++i) add_spring(s, i, -1, stiffness[i], 0.04);
    for (int p = 0; p < 1000; ++p) {
        const double x = (p % 40 - 19.5) / 20, y = (p / 40 - 12) / 12.5;
        s.gap_rows[3 * p] = 1;
        s.gap_rows[3 * p + 1] = x;
        s.gap_rows[3 * p + 2] = y;
        s.contact_stiffness[p] = 0.005;
        s.gap[p] = 0.3 * (x * x + 0.5 * y * y) + 1e-3 * std::sin(37.0 * p); // a crowned, rough bed
    }
    s.force = {0.3, 0.1, 0.05};
    s.preload = {0.5, 0.05, -0.03};
    Solver solver(s, range(0.8, 3, sampled));
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    m.error = orbit_error(s, *curve, 3, 250);
    return m;
}

// A thousand equal oscillators with stops, joined by springs and driven in phase: they move as one.
Measured thousand_oscillators(bool sampled) {
    const int n = 1000;
    exact::Structure s = empty(n, n);
    for (int i = 0; i < n; ++i) {
        add_spring(s, i, -1, 1, 0.04);
        if (i > 0) add_spring(s, i, i - 1, 1e6, 100);
        s.gap_rows[static_cast<std::size_t>(i) * n + i] = 1;
        s.force[i] = 1;
        s.preload[i] = 0.5;
    }
    set_contact(s, 3, 0);
    Setup setup = range(0.9, 2.2, sampled);
    setup.kind = "plm";
    Solver solver(s, setup);
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    const exact::Structure one = oscillator(0.02, 3, 0, 1, 0.5);
    m.error = orbit_error(one, *curve, 5, 1000);
    return m;
}

Measured one_pair(bool sampled) {
    const exact::Structure s = oscillator(0.02, 3, 0.5, 1, 0.2);
    Solver solver(s, range(0.6, 2.2, sampled));
    return sweep_against(s, solver, 2000);
}

// Three masses joined by springs, held by nothing but the contact they are pressed on.
exact::Structure free_chain() {
    exact::Structure s = empty(3, 1);
    add_spring(s, 0, 1, 1, 0.02);
    add_spring(s, 1, 2, 1, 0.02);
    for (int i = 0; i < 3; ++i) s.damping[4 * i] += 0.05;
    s.gap_rows = {1, 0, 0};
    set_contact(s, 4, 0);
    s.force = {0, 0, 0.2};
    s.preload = {0.1, 0, 0.9};
    return s;
}

Measured rigid_gentle(bool sampled) {
    exact::Structure s = free_chain();
    s.force[2] = 0.02;
    Solver solver(s, range(0.2, 1.2, sampled));
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    m.error = linear_error(s, {true}, *curve, 2);
    return m;
}

Measured rigid_lifting(bool sampled) {
    const exact::Structure s = free_chain();
    Solver solver(s, range(0.2, 1.2, sampled));
    return sweep_against(s, solver, 2000);
}

// Two masses that fly freely, joined by a spring and a stop and pressed on each other, in coordinates x = q_0
// - q_1 and q_1: x moves like the reduced mass on a support.
Measured free_flight(bool sampled) {
    const double left = 1, right = 3;
    exact::Structure truth = empty(1, 1);
    truth.mass = {left * right / (left + right)};
    add_spring(truth, 0, -1, 1, 0.02);
    truth.gap_rows = {1};
    set_contact(truth, 5, 0.3);
    truth.force = {truth.mass[0] / left};
    truth.preload = {0.1};
    exact::Structure s = empty(2, 1);
    add_spring(s, 0, -1, 1, 0.02);
    s.gap_rows = {1, 0};
    set_contact(s, 5, 0.3);
    s.force = {1, 1}; // on q_0
    s.preload = {0.1, 0};
    Solver solver(s, {left, left, left, left + right}, range(0.6, 2.6, sampled));
    return sweep_against(truth, solver, 2000);
}

// DOF 3 of four has no mass: its two springs, with dampers in proportion, are one spring in series.
Measured massless_inside(bool sampled) {
    exact::Structure truth = empty(3, 1); // masses 0, 1, 2; series spring between 1 and 2
    const double beta = 0.1;
    add_spring(truth, 0, -1, 1, beta);
    add_spring(truth, 1, 0, 1, beta);
    add_spring(truth, 2, 1, 2.0 * 3.0 / 5.0, beta * 6.0 / 5.0);
    truth.gap_rows = {0, 0, 1};
    set_contact(truth, 5, 0.3);
    truth.force = {0, 0, 1};
    exact::Structure s = empty(4, 1);
    add_spring(s, 0, -1, 1, beta);
    add_spring(s, 1, 0, 1, beta);
    add_spring(s, 3, 1, 2, beta * 2);
    add_spring(s, 2, 3, 3, beta * 3);
    s.gap_rows = {0, 0, 1, 0};
    set_contact(s, 5, 0.3);
    s.force = {0, 0, 1, 0};
    std::vector<double> mass(16, 0.0);
    for (int i = 0; i < 3; ++i) mass[5 * i] = 1;
    Solver solver(s, mass, range(0.2, 1.5, sampled));
    return sweep_against(truth, solver, 2000);
}

// The contact stands on a mass-less DOF behind an undamped spring: together one stop of the series stiffness.
Measured massless_in_contact(bool sampled) {
    exact::Structure truth = chain(2, 0.03, {1});
    set_contact(truth, 2.0 * 5.0 / 7.0, 0.3);
    exact::Structure s = empty(3, 1);
    for (int i = 0; i < 2; ++i) add_spring(s, i, i - 1, 1, truth.damping[3]); // of one spring
    add_spring(s, 2, 1, 2, 0);
    s.gap_rows = {0, 0, 1};
    set_contact(s, 5, 0.3);
    s.force = {0, 1, 0};
    std::vector<double> mass(9, 0.0);
    mass[0] = mass[4] = 1;
    Solver solver(s, mass, range(0.3, 1.5, sampled));
    return sweep_against(truth, solver, 2000);
}

// A steel chain in m-kg-s, and the same in other units of mass, length and time.
exact::Structure in_units(double mass, double length, double time) {
    exact::Structure s = chain(4, 0.02, {1, 3});
    const double k = 3e6 * mass / (time * time), m = 0.7 * mass; // 3e6 N/m, 0.7 kg
    set_contact(s, 10 * local_stiffness(s), 0.3);
    const double c = std::sqrt(3e6 * 0.7) * mass / time;
    for (double &v : s.stiffness) v *= k;
    for (double &v : s.damping) v *= c;
    for (double &v : s.mass) v *= m;
    for (double &v : s.contact_stiffness) v *= k;
    for (double &v : s.gap) v *= 1e-4 * length;
    for (double &v : s.force) v *= 3e6 * 1e-4 * 0.3 * mass * length / (time * time);
    s.preload[3] = 3e6 * 1e-4 * 0.2 * mass * length / (time * time);
    return s;
}

// Units of mass, length and time: how many of them one kg, m and s are. Compared at the same frequencies,
// each from the nearest point of the own sweep (the points of two sweeps differ by rounding), and at the
// peak.
Measured units(double mass, double length, double time, bool sampled) {
    const double w = std::sqrt(3e6 / 0.7);
    Solver a(in_units(1, 1, 1), range(0.3 * w, 0.9 * w, sampled)),
        b(in_units(mass, length, time), range(0.3 * w / time, 0.9 * w / time, sampled));
    const auto one = a.sweep(), other = b.sweep();
    Measured m = outcome_of(*other);
    if (one->size() != other->size()) return m;
    m.error = std::abs(b.peak(*other, 3).second / length / a.peak(*one, 3).second - 1);
    for (std::size_t i = 0; i < one->size(); i += 5) {
        const auto want = a.solve(one->omega[i], one.get(), i);
        const auto got = b.solve(one->omega[i] / time, other.get(), i);
        m.error = std::max(m.error, std::abs(got->amplitude(3)[0] / length / want->amplitude(3)[0] - 1));
    }
    return m;
}

Measured no_resonance(bool sampled) {
    exact::Structure s = chain(4, 0.02, {1, 3});
    set_contact(s, 10 * local_stiffness(s), 0);
    Solver solver(s, range(6, 9, sampled)); // all closed systems end below 5
    return sweep_against(s, solver, 4000);
}

// Two oscillators, uncoupled but for a whisper, 1e-4 apart; one of them meets a stop.
Measured close_resonances(bool sampled) {
    exact::Structure s = empty(2, 1);
    const double zeta = 2e-5;
    add_spring(s, 0, -1, 1, 2 * zeta);
    add_spring(s, 1, -1, 1.0002, 2 * zeta);
    add_spring(s, 1, 0, 1e-5, 0);
    s.gap_rows = {0, 1};
    set_contact(s, 1e-2, 0.8 / (2 * zeta) * 1e-4);
    s.force = {1e-4, 1e-4};
    Solver solver(s, range(0.9995, 1.001, sampled));
    return sweep_against(s, solver, 2000);
}

} // namespace

std::vector<Row> structure_rows() {
    std::vector<Row> rows;
    rows.push_back({"pairs-1", "one mass, one pair, gap and pre-load", "exact orbits", 1e-3, true, one_pair});
    rows.push_back({"pairs-1000-block", "rigid block on 1,000 unilateral springs, pre-load", "exact orbits",
                    1e-3, false, block_on_a_thousand_springs});
    rows.push_back({"pairs-1000-oscillators", "1,000 equal oscillators moving as one, pre-load, PLM basis",
                    "exact orbits of one", 1e-3, false, thousand_oscillators});
    rows.push_back({"rigid-body-resting", "free chain on one contact, pressed, never lifting",
                    "linear answer", 1e-11, true, rigid_gentle});
    rows.push_back({"rigid-body-lifting", "free chain on one contact, pressed, lifting off", "exact orbits",
                    1e-3, true, rigid_lifting});
    rows.push_back({"free-flight", "two masses held by nothing, pressed on each other, with a stop",
                    "exact orbits of the reduced mass", 1e-3, true, free_flight});
    rows.push_back({"mass-less-inside", "a DOF without mass between springs", "exact orbits", 1e-3, true,
                    massless_inside});
    // Its displacement has kinks itself: errors fall as H^-2.
    rows.push_back({"mass-less-contact", "contact on a DOF without mass", "exact orbits", 1e-3, true,
                    massless_in_contact});
    rows.push_back({"units-mm-t-s", "peak and every fifth point in mm-t-s against m-kg-s", "m-kg-s", 1e-9,
                    true, [](bool sampled) { return units(1e-3, 1e3, 1, sampled); }});
    rows.push_back({"units-silly", "3.7e11 to the kg, 2.9e-7 to the m, 4.1e5 to the s", "m-kg-s", 1e-9, true,
                    [](bool sampled) { return units(3.7e11, 2.9e-7, 4.1e5, sampled); }});
    rows.push_back(
        {"no-resonance", "window above every resonance", "exact orbits", 1e-3, true, no_resonance});
    rows.push_back({"close-resonances", "two resonances 1e-4 apart, damping 2e-5, stop on one",
                    "exact orbits", 1e-3, true, close_resonances});
    return rows;
}

} // namespace extreme
