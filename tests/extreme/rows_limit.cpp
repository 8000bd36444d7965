// Limits of what a scene may be: touch, force, damping, harmonics, contact that never changes.
#include "dense.hpp"
#include "row.hpp"
#include "structures.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace extreme {
namespace {

struct Sweep {
    double low, high;
    int dof;
    int harmonics = 0; // 0: the default
    int samples = 2000;
};

Setup setup_of(const Sweep &w, bool sampled, double force = 1) {
    Setup setup;
    setup.low = w.low, setup.high = w.high;
    setup.harmonics = w.harmonics;
    setup.sampled = sampled;
    setup.force_scale = force;
    return setup;
}

Measured against_orbits(const exact::Structure &s, const Sweep &w, bool sampled, double force = 1) {
    Solver solver(s, setup_of(w, sampled, force));
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    exact::Structure truth = s;
    for (double &f : truth.force) f *= force;
    m.error = orbit_error(truth, *curve, 6, w.samples);
    return m;
}

Measured against_linear(const exact::Structure &s, const std::vector<bool> &closed, const Sweep &w,
                        bool sampled, double force = 1) {
    Solver solver(s, setup_of(w, sampled, force));
    const auto curve = solver.sweep();
    Measured m = outcome_of(*curve);
    exact::Structure truth = s;
    for (double &f : truth.force) f *= force;
    m.error = linear_error(truth, closed, *curve, w.dof);
    return m;
}

// Frequency of the highest open response in a range with one resonance.
double linear_resonance(const exact::Structure &s, double low, double high, int dof) {
    const std::vector<bool> open(s.z, false);
    for (int k = 0; k < 120; ++k) { // a third is cut off in each round
        const double left = low + (high - low) / 3, right = high - (high - low) / 3;
        if (linear_peak(s, open, left, dof) < linear_peak(s, open, right, dof)) {
            low = left;
        } else {
            high = right;
        }
    }
    return low;
}

// Gap = (1 + share) times the highest linear amplitude: contact is missed or touched by that share.
Row grazing(const char *name, double share) {
    char parameters[128];
    std::snprintf(parameters, sizeof parameters, "gap = linear peak x (1 %c %.0e), k_n = 100 k_loc",
                  share > 0 ? '+' : '-', std::abs(share));
    // Missed: linear to rounding. Touched by delta: the contact force is of the order k_n delta, for a share
    // sqrt(2 delta) / pi of the period, and the resonance (25) acts on it.
    const double delta = std::abs(share), touched = 25 * 100 * delta * std::sqrt(2 * delta);
    const double tolerance = 1e-12 + (share > 0 ? 0 : touched);
    return {name, parameters, "linear answer", tolerance, true, [=](bool sampled) {
                exact::Structure s = chain(4, 0.02, {3});
                const double omega = linear_resonance(s, 0.3, 0.4, 3);
                const double peak = linear_peak(s, {false}, omega, 3);
                set_contact(s, 100 * local_stiffness(s), peak * (1 + share));
                Solver solver(s, setup_of({0.3, 0.4, 3}, sampled));
                const auto curve = solver.sweep(), top = solver.solve(omega);
                Measured m = outcome_of(*curve);
                m.work.add(top->work);
                m.error =
                    std::max({linear_error(s, {false}, *curve, 3), std::abs(top->amplitude(3)[0] / peak - 1),
                              std::abs(solver.peak(*curve, 3).second / peak - 1)});
                return m;
            }};
}

exact::Structure loaded_chain() {
    exact::Structure s = chain(4, 0.02, {1, 3});
    set_contact(s, 10 * local_stiffness(s), 0);
    s.gap = {-0.2, 0.5}; // one pair pressed together, one at a distance
    s.preload[3] = 0.4;
    return s;
}

std::vector<bool> rest_of_loaded_chain() {
    return {true, true}; // 4 x 0.4 > 0.5: the end touches the ground at rest
}

Measured small_force(bool sampled) {
    return against_linear(loaded_chain(), rest_of_loaded_chain(), {0.3, 0.9, 3}, sampled, 1e-6);
}

// Without pre-load and gap: all points of the curve at three forces.
Measured homogeneous(double force, bool sampled) {
    exact::Structure s = chain(4, 0.02, {1, 3});
    set_contact(s, 10 * local_stiffness(s), 0);
    const Sweep w{0.3, 0.9, 3};
    Solver one(s, setup_of(w, sampled)), other(s, setup_of(w, sampled, force));
    const auto a = one.sweep(), b = other.sweep();
    Measured m = outcome_of(*b);
    const std::vector<double> want = a->amplitude(3), got = b->amplitude(3);
    m.error = a->size() == b->size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(want.size(), got.size()); ++i)
        m.error = std::max(
            {m.error, std::abs(got[i] / force / want[i] - 1), std::abs(b->omega[i] / a->omega[i] - 1)});
    return m;
}

exact::Structure damped(double zeta) {
    exact::Structure s = chain(4, zeta, {1, 3});
    set_contact(s, 10 * local_stiffness(s), 0);
    s.gap[1] = 0.5;
    return s;
}

// One scene, one frequency, exact orbit.
double error_at(const exact::Structure &s, double omega, int harmonics, bool sampled, Measured &m) {
    Solver solver(s, setup_of({0.5 * omega, 1.5 * omega, 3, harmonics}, sampled));
    const auto point = solver.solve(omega);
    m = outcome_of(*point);
    const exact::Orbit orbit = exact::periodic_orbit(s, omega, point->state(0, s.n), 0, 4000);
    return orbit.converged ? std::abs(point->amplitude(3)[0] / orbit.peak(3) - 1) : 1e300;
}

exact::Structure harmonics_scene() {
    exact::Structure s = chain(4, 0.05, {1, 3});
    set_contact(s, 5 * local_stiffness(s), 0);
    s.preload[3] = 0.3;
    return s;
}
constexpr double harmonics_omega = 0.6;
const int harmonics_list[] = {1, 2, 3, 5, 8, 13, 21, 34, 50};

Measured monotone(bool sampled) {
    double last = 1e300, worst = 0;
    Measured all;
    for (int h : harmonics_list) {
        Measured m;
        const double error = error_at(harmonics_scene(), harmonics_omega, h, sampled, m);
        worst = std::max(worst, error / last);
        last = error;
        all.reason = m.reason;
        all.outcome = m.outcome;
        all.work.add(m.work);
    }
    all.error = worst;
    return all;
}

} // namespace

std::vector<Row> limit_rows() {
    std::vector<Row> rows;
    rows.push_back(grazing("grazing-missed-1e-6", 1e-6));
    rows.push_back(grazing("grazing-missed-1e-12", 1e-12));
    rows.push_back(grazing("grazing-touched-1e-6", -1e-6));
    rows.push_back(grazing("grazing-touched-1e-12", -1e-12));

    rows.push_back({"force-1e-6-loaded", "force x 1e-6, pre-load and gaps, k_n = 10 k_loc",
                    "linear answer at rest", 1e-12, true, small_force});
    rows.push_back({"force-1e3-loaded", "force x 1e3, pre-load and gaps, k_n = 10 k_loc", "exact orbits",
                    1e-3, true, [](bool sampled) {
                        return against_orbits(loaded_chain(), {0.3, 0.9, 3}, sampled, 1e3);
                    }});
    for (double force : {1e-6, 1e3})
        rows.push_back({force < 1 ? "force-1e-6-homogeneous" : "force-1e3-homogeneous",
                        "no pre-load, no gap: all points against those at force 1, k_n = 10 k_loc",
                        "proportionality", 1e-10, true,
                        [=](bool sampled) { return homogeneous(force, sampled); }});

    rows.push_back(
        {"damping-none", "no damping, above all resonances", "exact orbits", 1e-3, true, [](bool sampled) {
             exact::Structure s = oscillator(0, 3, 0.05, 1, 0);
             return against_orbits(s, {2.6, 4.5, 0}, sampled);
         }});
    rows.push_back({"damping-50", "50 % damping", "exact orbits", 1e-3, true, [](bool sampled) {
                        return against_orbits(damped(0.5), {0.1, 2, 3}, sampled);
                    }});
    for (int h : harmonics_list) {
        char name[64], parameters[96];
        std::snprintf(name, sizeof name, "harmonics-%d", h);
        std::snprintf(parameters, sizeof parameters, "H = %d, 4 masses, 2 pairs, pre-load, k_n = 5 k_loc", h);
        // The force has kinks: errors fall as H^-3.
        rows.push_back({name, parameters, "exact orbit", 1.0 / (h * h * h), true, [=](bool sampled) {
                            Measured m;
                            m.error = error_at(harmonics_scene(), harmonics_omega, h, sampled, m);
                            return m;
                        }});
    }
    rows.push_back({"harmonics-monotone",
                    "H = 1, 2, 3, 5, 8, 13, 21, 34, 50: largest ratio of successive errors", "below 1", 1,
                    true, monotone});
    rows.push_back({"always-open", "gaps out of reach", "linear answer", 1e-12, true, [](bool sampled) {
                        exact::Structure s = chain(5, 0.02, {1, 2, 4});
                        set_contact(s, 10 * local_stiffness(s), 1e3);
                        return against_linear(s, {false, false, false}, {0.2, 1.2, 4}, sampled);
                    }});
    rows.push_back(
        {"always-closed", "interference beyond the motion", "linear answer", 1e-12, true, [](bool sampled) {
             exact::Structure s = chain(5, 0.02, {1, 2, 4});
             set_contact(s, 10 * local_stiffness(s), -1e3);
             return against_linear(s, {true, true, true}, {0.2, 1.2, 4}, sampled);
         }});
    return rows;
}

} // namespace extreme
