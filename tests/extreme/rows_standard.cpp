// The literature's two-mass oscillator with a stop, and cold starts on the cracked plate.
#include "row.hpp"
#include "structures.hpp"
#include "scene.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace extreme {
namespace {

// Krack & Gross, Harmonic Balance for Nonlinear Vibration Problems, Springer 2019 (example 3 of NLvib): unit
// masses and springs in a chain from the ground, dampers 0.03, a stop of stiffness 100 at a distance 1 of the
// first mass, force 0.1 on the second. The curve grazes the stop on its flank and bends over.
exact::Structure two_masses() {
    exact::Structure s = empty(2, 1);
    add_spring(s, 0, -1, 1, 0.03);
    add_spring(s, 1, 0, 1, 0.03);
    s.gap_rows = {1, 0};
    set_contact(s, 100, 1);
    s.force = {0, 0.1};
    return s;
}

double first_harmonic(const exact::Orbit &orbit, int dof) {
    double c = 0, s = 0;
    const std::size_t n = orbit.samples.size();
    for (std::size_t i = 0; i < n; ++i) {
        const double t = 2 * M_PI * static_cast<double>(i) / static_cast<double>(n);
        c += orbit.samples[i][dof] * std::cos(t);
        s += orbit.samples[i][dof] * std::sin(t);
    }
    return std::hypot(c, s) * 2 / static_cast<double>(n);
}

// Largest first harmonic of exact orbits over the frequency, from a point of the curve near it.
double exact_maximum(const exact::Structure &s, double omega, std::vector<double> state, int dof) {
    double best = 0, at = omega;
    const auto higher = [&](double w) {
        const exact::Orbit orbit = exact::periodic_orbit(s, w, state, 0, 4000);
        const double h = orbit.converged ? first_harmonic(orbit, dof) : 0;
        if (!(h > best && (best == 0 || h < 1.1 * best))) return false;
        best = h, at = w, state = orbit.start;
        return true;
    };
    higher(omega);
    for (double step = 1e-3 * omega; step > 1e-7 * omega; step *= 0.5)
        while (higher(at + step) || higher(at - step)) {
        }
    return best;
}

Measured standard(int harmonics, bool upward, bool sampled) {
    const exact::Structure s = two_masses();
    Setup setup;
    setup.low = 0.5, setup.high = 0.8;
    setup.harmonics = harmonics;
    setup.upward = upward;
    setup.sampled = sampled;
    Solver solver(s, setup);
    const std::clock_t begin = std::clock();
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    m.work.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC; // of the processor
    m.time_limit = 0.3;
    const auto peak = solver.peak(*curve, 1, PLM_HARMONIC, 1);
    const std::vector<double> a = curve->amplitude(1, PLM_HARMONIC, 1);
    const std::size_t top = std::max_element(a.begin(), a.end()) - a.begin();
    const double truth = exact_maximum(s, curve->omega[top], curve->state(top, 2), 1);
    m.error = std::abs(peak.second / truth - 1);
    return m;
}

// Starts without a guess at 25 frequencies over the window; the error is how many fail.
Measured cold_starts(double ratio, bool sampled) {
    scene *plate = nullptr;
    if (scene_create("cracked_plate", "quick", 1, &plate)) return Measured();
    const std::unique_ptr<scene, void (*)(scene *)> owner(plate, [](scene *s) { scene_destroy(&s); });
    Setup setup;
    setup.kind = "plm";
    setup.sampler = {{"system", plate->dominant_system}, {"mode", plate->dominant_mode}};
    setup.sampled = sampled;
    const double local = Solver(*plate, setup).model_stiffness();
    for (std::int64_t i = 0; i < plate->n_pairs; ++i) plate->contact_stiffness[i] = ratio * local;
    Solver solver(*plate, setup);
    Measured m;
    m.error = 0;
    m.reason = PLM_REASON_RANGE_END;
    std::string failing;
    for (int i = 0; i < 25; ++i) {
        const double omega =
            solver.window_low() + (solver.window_high() - solver.window_low()) * i / 24;
        try {
            m.work.add(solver.solve(omega)->work);
        } catch (const Failure &) {
            char text[32];
            std::snprintf(text, sizeof text, " %.6f Hz", omega / (2 * M_PI));
            failing += text;
            m.error += 1;
        }
    }
    m.outcome = std::to_string(25 - static_cast<int>(m.error)) + " of 25 converged";
    if (!failing.empty()) m.outcome += ", not:" + failing;
    return m;
}

} // namespace

std::vector<Row> standard_rows() {
    std::vector<Row> rows;
    // H = 21, the literature's, leaves 3e-3 at the peak whoever solves it (H = 30: 3e-4, 42: 2e-5, 63: 3e-6).
    for (int h : {21, 42})
        for (bool upward : {false, true}) {
            const std::string end = (upward ? "up-" : "down-") + std::to_string(h);
            rows.push_back({"two-masses-" + end,
                            "two-mass oscillator of the literature, H = " + std::to_string(h) + ", below 0.3 s",
                            "highest exact orbit", h == 21 ? 5e-3 : 1e-4, true,
                            [=](bool sampled) { return standard(h, upward, sampled); }});
        }
    for (int ratio : {1, 10, 100, 1000}) {
        const std::string k = std::to_string(ratio);
        rows.push_back({"cold-" + k, "cracked plate, pre-load, 25 frequencies without a guess, k_n = " + k + " k_loc",
                        "failing starts", 0, true, [=](bool sampled) { return cold_starts(ratio, sampled); }});
    }
    return rows;
}

} // namespace extreme
