// Response curves against independent truths: closed forms and exact periodic orbits of the piecewise-linear
// flow.
#include "contact/trig_polynomial.hpp"
#include "support/small_solver.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <cmath>

using plm::HbmOptions;
using test::peak_at;

namespace {

// Amplitude of one DOF straight from reduced coordinates: these models have no FE model behind them.
plm::Hbm solver(std::shared_ptr<const plm::ReducedModel> m, HbmOptions o, double low, double high) {
    o.tolerance = 1e-11;
    return test::solver(std::move(m), o, low, high);
}

double amplitude_at(std::shared_ptr<const plm::ReducedModel> m, double omega, int harmonics, int dof) {
    HbmOptions o;
    o.n_harmonics = harmonics;
    const auto branch = solver(m, o, 0.5 * omega, 2 * omega).solve(omega / (2 * M_PI), nullptr, 0);
    return peak_at(*m, branch->points()[0], dof);
}

// Zero gap, stiffness 1 open and 1 + 3 closed: free frequency 2 w1 w2 / (w1 + w2) = 4/3 exactly (paper, eq.
// (6)).
double resonance_of_bilinear_oscillator(int harmonics) {
    const auto m = test::reduce_exactly(test::bilinear_oscillator(1e-4, 3, 0, 1e-3, 0));
    HbmOptions o;
    o.n_harmonics = harmonics;
    const double blf = 4.0 / 3.0;
    const auto branch = solver(m, o, 0.998 * blf, 1.002 * blf).sweep();
    double best = 0,
           at = 0; // parabola through the three highest points would do; a fine sweep around them does better
    for (const auto &p : branch->points())
        if (peak_at(*m, p, 0) > best) best = peak_at(*m, p, 0), at = p.omega;
    o.max_step = 0.01;
    const auto fine = solver(m, o, at * (1 - 1e-4), at * (1 + 1e-4)).sweep();
    std::vector<double> w, a;
    for (const auto &p : fine->points()) w.push_back(p.omega), a.push_back(peak_at(*m, p, 0));
    const std::size_t top = static_cast<std::size_t>(std::max_element(a.begin(), a.end()) - a.begin());
    if (top == 0 || top + 1 >= a.size()) return 0;
    const double l = (a[top] - a[top - 1]) / (w[top] - w[top - 1]),
                 r = (a[top + 1] - a[top]) / (w[top + 1] - w[top]);
    return 0.5 * (w[top] + w[top - 1]) - l * (w[top + 1] - w[top - 1]) / (2 * (r - l)); // vertex
}
void free_frequency_is_the_bilinear_frequency(void **) {
    const double got = resonance_of_bilinear_oscillator(40);
    std::printf("    resonance %.9f, BLF %.9f\n", got, 4.0 / 3.0);
    assert_true(
        close_to(got, 4.0 / 3.0, 1e-6)); // the peak of a light damping of 1e-4 is within 1e-8 of the free one
}

struct Convergence {
    double exact = 0;
    std::vector<int> harmonics;
    std::vector<double> error;
};
Convergence bilinear_convergence(double omega, double zeta, double kc, double gap, double preload) {
    const exact::Structure s = test::bilinear_oscillator(zeta, kc, gap, 1.0, preload);
    const auto m = test::reduce_exactly(s);
    Convergence c;
    const exact::Orbit orbit = exact::periodic_orbit(s, omega, {}, 60, 2000);
    c.exact = orbit.converged ? orbit.peak(0) : 0;
    for (int h : {1, 3, 5, 10, 20, 40, 80}) {
        c.harmonics.push_back(h);
        c.error.push_back(std::abs(amplitude_at(m, omega, h, 0) / c.exact - 1));
    }
    return c;
}
void report(const char *what, const Convergence &c) {
    std::printf("    %s: exact %.9g; relative error at H", what, c.exact);
    for (std::size_t i = 0; i < c.error.size(); ++i) std::printf(" %d: %.1e", c.harmonics[i], c.error[i]);
    std::printf("\n");
}
void forced_bilinear_oscillator_converges_to_the_exact_orbit(void **) {
    const Convergence zero_gap = bilinear_convergence(1.1, 0.05, 3, 0, 0);
    report("zero gap", zero_gap);
    assert_true(zero_gap.exact > 0);
    assert_true(below(zero_gap.error.back(), 1e-6)); // the force has kinks: errors fall as H^-3
    const Convergence positive_gap = bilinear_convergence(0.9, 0.05, 3, 0.5, 0);
    report("gap", positive_gap);
    assert_true(positive_gap.exact > 0);
    assert_true(below(positive_gap.error.back(), 1e-6));
    const Convergence preloaded = bilinear_convergence(1.2, 0.05, 3, 0, 0.6);
    report("pre-load", preloaded);
    assert_true(preloaded.exact > 0);
    assert_true(below(preloaded.error.back(), 1e-6));
}

// The state (q, q') at t = 0 of an HBM solution: from there shooting finds the exact orbit next to it.
std::vector<double> state_at_zero(const plm::ReducedModel &m, const plm::BranchPoint &p) {
    const std::int64_t n = m.vectors.rows();
    std::vector<double> state(2 * n, 0.0);
    for (std::int64_t dof = 0; dof < n; ++dof) {
        const auto q = test::displacement(m, p.eta_0, p.eta, dof);
        const plm::TrigValue v = plm::evaluate_trig(q.data(), p.eta.cols() / 2, 0.0);
        state[dof] = v.value;
        state[n + dof] = p.omega * v.slope;
    }
    return state;
}

// Amplitude of an HBM solution against the exact orbit next to it (there may be several at one frequency).
double error_at(const exact::Structure &s, double omega, int harmonics, int dof, int samples) {
    const auto m = test::reduce_exactly(s);
    HbmOptions o;
    o.n_harmonics = harmonics;
    const auto branch = solver(m, o, 0.5 * omega, 2 * omega).solve(omega / (2 * M_PI), nullptr, 0);
    const plm::BranchPoint &p = branch->points()[0];
    const exact::Orbit orbit = exact::periodic_orbit(s, omega, state_at_zero(*m, p), 0, samples);
    return orbit.converged ? std::abs(peak_at(*m, p, dof) / orbit.peak(dof) - 1) : 1e300;
}

// A chain with three contacts at five frequencies.
std::vector<double> chain_errors() {
    const exact::Structure s = test::chain(5, 0.03, 4, 0.02, 0.3, 0.2, {1, 3, 4});
    std::vector<double> errors;
    for (double omega : {0.3, 0.45, 0.7, 1.0, 1.4}) errors.push_back(error_at(s, omega, 30, 4, 1000));
    return errors;
}
void chain_agrees_with_exact_time_marching(void **) {
    const std::vector<double> errors = chain_errors();
    std::printf("    H = 30 against the exact orbit at five frequencies:");
    for (double e : errors) std::printf(" %.1e", e);
    std::printf("\n");
    for (double e : errors) assert_true(below(e, 1e-3));
}

struct SweepFacts {
    std::int32_t reason = 0;
    std::size_t points = 0;
    int folds = 0;
    double highest = 0, at = 0;
};
SweepFacts sweep(std::shared_ptr<const plm::ReducedModel> m, HbmOptions o, double low, double high, int dof) {
    const auto branch = solver(m, o, low, high).sweep();
    SweepFacts f;
    f.reason = branch->end_reason;
    f.points = branch->points().size();
    double last = 0;
    for (std::size_t i = 0; i < f.points; ++i) {
        const auto &p = branch->points()[i];
        const double a = peak_at(*m, p, dof);
        if (a > f.highest) f.highest = a, f.at = p.omega;
        if (i > 0) {
            const double step = p.omega - branch->points()[i - 1].omega;
            if (last * step < 0) ++f.folds;
            last = step;
        }
    }
    return f;
}

// A stop at a distance bends the resonance to the right: two folds, the same from both sides.
void sweeps_pass_folds_in_both_directions(void **) {
    const auto m = test::reduce_exactly(test::bilinear_oscillator(0.01, 3, 1.0, 0.1, 0));
    HbmOptions o;
    o.n_harmonics = 9;
    const SweepFacts down = sweep(m, o, 0.6, 1.8, 0);
    o.upward = true;
    const SweepFacts up = sweep(m, o, 0.6, 1.8, 0);
    std::printf(
        "    down: %zu points, %d folds, top %.6g at %.6g; up: %zu points, %d folds, top %.6g at %.6g\n",
        down.points, down.folds, down.highest, down.at, up.points, up.folds, up.highest, up.at);
    assert_int_equal(down.reason, plm::reason::range_end);
    assert_int_equal(up.reason, plm::reason::range_end);
    assert_true(down.folds >= 2 && up.folds >= 2);
    assert_true(close_to(down.highest, up.highest, 2e-2)); // discrete points of two sweeps
}

// Without pre-load and gap the equations are homogeneous of degree one.
struct Homogeneous {
    double frequency_spread = 0, amplitude_spread = 0;
};
Homogeneous homogeneity() {
    const auto m = test::reduce_exactly(test::chain(5, 0.03, 20, 0, 1.0, 0, {1, 3, 4}));
    HbmOptions o;
    o.n_harmonics = 5;
    o.tolerance = 1e-11; // two orders below the bounds
    Homogeneous h;
    double w0 = 0, a0 = 0;
    for (double force : {1.0, 1e-3, 1e3}) {
        o.force_scale = force;
        const SweepFacts f = sweep(m, o, 0.2, 0.5, 4);
        if (force == 1.0) w0 = f.at, a0 = f.highest;
        h.frequency_spread = std::max(h.frequency_spread, std::abs(f.at / w0 - 1));
        h.amplitude_spread = std::max(h.amplitude_spread, std::abs(f.highest / force / a0 - 1));
    }
    return h;
}
void response_without_preload_is_proportional_to_the_force(void **) {
    const Homogeneous h = homogeneity();
    assert_true(below(h.frequency_spread, 1e-9));
    assert_true(below(h.amplitude_spread, 1e-9));
}

// Extreme contact stiffness, one pair: HBM with many harmonics against the exact orbit.
double stiff_error(double kc, int harmonics) {
    return error_at(test::bilinear_oscillator(0.1, kc, 0.3, 1.0, 0), 0.8, harmonics, 0, 4000);
}
void soft_and_stiff_contact_converge(void **) {
    for (double kc : {1e-3, 1.0, 1e2, 1e3}) {
        const int harmonics = kc > 1e2 ? 100 : 50; // contact lasts pi / sqrt(kc): harmonics must resolve it
        const double error = stiff_error(kc, harmonics);
        std::printf("    k_n / k = %g, H = %d: %.1e\n", kc, harmonics, error);
        assert_true(below(error, 1e-4));
    }
}

// Through the resonance into a hard stop: the upper branch leaves the range steeply, at the boundary itself.
double last_frequency(double zeta, double high) {
    const double resonance = 1 / (2 * zeta);
    const auto m = test::reduce_exactly(test::bilinear_oscillator(zeta, 1e3, 0.3 * resonance, 1, 0));
    HbmOptions o;
    o.n_harmonics = 7;
    o.upward = true;
    o.stability = plm::StabilityKind::off;
    const auto branch = solver(m, o, 0.8, high).sweep();
    return branch->end_reason == plm::reason::range_end ? branch->points().back().omega : -1;
}
void a_curve_that_ends_at_its_range_has_its_last_point_there(void **) {
    for (double zeta : {5e-3, 5e-4})
        for (double high : {1.26, 1.28, 1.3, 1.32, 1.34, 1.36, 1.38, 1.4})
            assert_true(close_to(last_frequency(zeta, high), high, 1e-12));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(free_frequency_is_the_bilinear_frequency),
        cmocka_unit_test(forced_bilinear_oscillator_converges_to_the_exact_orbit),
        cmocka_unit_test(chain_agrees_with_exact_time_marching),
        cmocka_unit_test(sweeps_pass_folds_in_both_directions),
        cmocka_unit_test(a_curve_that_ends_at_its_range_has_its_last_point_there),
        cmocka_unit_test(response_without_preload_is_proportional_to_the_force),
        cmocka_unit_test(soft_and_stiff_contact_converge),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
