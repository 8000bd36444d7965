// Nonlinear modes against closed forms of the bilinear oscillator: frequency, energy, contact time, damping.
#include "contact/trig_polynomial.hpp"
#include "hbm/nonlinear_mode.hpp"
#include "hbm/options.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <cmath>

namespace {

plm::NonlinearMode mode_of(const exact::Structure &s, double omega, double low, double high, int harmonics) {
    plm::NonlinearModeOptions o;
    o.hbm.n_harmonics = harmonics;
    o.hbm.tolerance = 1e-11;
    o.frequency_hz = omega / (2 * M_PI);
    o.amplitude_min = low;
    o.amplitude_max = high;
    return plm::follow_nonlinear_mode(test::reduce_exactly(s), o, plm::Watch());
}

// q'' + q + 3 max(q - g, 0) = 0 with energy E: free on one side, w = 2 about 3 g / 4 on the other.
struct Exact {
    double omega, closed;
};
Exact piecewise(double gap, double energy) {
    const double a = std::sqrt(2 * energy);
    if (a <= gap) return {1, 0};
    const double speed = std::sqrt(a * a - gap * gap), b = std::hypot(gap / 4, speed / 2);
    const double open = M_PI + 2 * std::asin(gap / a), closed = std::acos(gap / 4 / b);
    return {2 * M_PI / (open + closed), closed / (open + closed)};
}

struct Errors {
    std::size_t points = 0;
    std::int32_t reason = 0;
    double frequency = 0, closed = 0, energy = 0, damping = 0, low = 1e300, high = 0;
};
Errors against_closed_form(const plm::NonlinearMode &mode, double gap) {
    Errors e;
    const auto &points = mode.branch->points();
    e.points = points.size();
    e.reason = mode.branch->end_reason;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const plm::BranchPoint &p = points[i];
        const auto q = test::displacement(mode.branch->reduced(), p.eta_0, p.eta, 0);
        const double open_side = -plm::trig_range(q.data(), p.eta.cols() / 2).minimum;
        const Exact x = piecewise(gap, 0.5 * open_side * open_side);
        e.frequency = std::max(e.frequency, std::abs(p.omega / x.omega - 1));
        e.closed = std::max(e.closed, std::abs(mode.measures[i].closed_share - x.closed));
        e.energy = std::max(e.energy, std::abs(mode.measures[i].total / (0.5 * open_side * open_side) - 1));
        e.damping = std::max(e.damping, std::abs(p.damping_ratio));
        e.low = std::min(e.low, p.omega);
        e.high = std::max(e.high, p.omega);
    }
    return e;
}
void print(const char *what, const Errors &e) {
    std::printf("    %s: %zu points, w %.6f to %.6f; errors: frequency %.1e, contact time %.1e, energy %.1e, "
                "xi %.1e\n",
                what, e.points, e.low, e.high, e.frequency, e.closed, e.energy, e.damping);
}

Errors homogeneous() {
    return against_closed_form(mode_of(test::bilinear_oscillator(0, 3, 0, 0, 0), 4.0 / 3, 0.01, 100, 40), 0);
}
void bilinear_frequency_at_every_amplitude(void **) {
    const Errors e = homogeneous();
    print("no gap", e);
    assert_int_equal(e.reason, plm::reason::range_end);
    assert_true(below(std::abs(e.low / (4.0 / 3) - 1), 1e-6));
    assert_true(below(std::abs(e.high / (4.0 / 3) - 1), 1e-6));
    assert_true(below(e.damping, 1e-10));
}

Errors with_gap() {
    return against_closed_form(mode_of(test::bilinear_oscillator(0, 3, 1, 0, 0), 1, 0.5, 20, 20), 1);
}
void gap_stiffens_as_the_exact_motion_does(void **) {
    const Errors e = with_gap();
    print("gap", e);
    assert_int_equal(e.reason, plm::reason::range_end);
    assert_true(e.low > 0.999999 && e.high > 1.3);
    assert_true(below(e.frequency, 1e-4));
    assert_true(below(e.closed, 1e-3));
    assert_true(below(e.energy, 1e-3));
    assert_true(below(e.damping, 1e-10));
}

struct Damped {
    double first_frequency = 0, first_damping = 0, last_frequency = 0, first_energy = 0, first_amplitude = 0;
    double first_share = 0, last_share = 0, least_damping = 1;
};
Damped preloaded() {
    const auto mode =
        mode_of(test::bilinear_oscillator(0.01, 3, 0, 0, 0.5), 2, 0, 0, 12); // range found by itself
    Damped d;
    d.first_frequency = mode.branch->points().front().omega;
    d.last_frequency = mode.branch->points().back().omega;
    d.first_damping = mode.branch->points().front().damping_ratio;
    d.first_energy = mode.measures.front().total;
    d.first_amplitude = mode.amplitude.front();
    d.first_share = mode.measures.front().closed_share;
    d.last_share = mode.measures.back().closed_share;
    for (const plm::BranchPoint &p : mode.branch->points())
        d.least_damping = std::min(d.least_damping, p.damping_ratio);
    return d;
}
void preload_keeps_contact_until_it_opens(void **) {
    const Damped d = preloaded();
    std::printf("    w %.6f to %.6f, xi %.6f, closed %.3f to %.3f\n", d.first_frequency, d.last_frequency,
                d.first_damping, d.first_share, d.last_share);
    assert_true(close_to(d.first_frequency, 2, 1e-9)); // closed: 1 + 3; EPMC leaves the undamped frequency
    assert_true(close_to(d.first_damping, 0.02 / (2 * 2), 1e-9));
    assert_true(close_to(d.first_amplitude, 0.0625, 1e-9)); // half of 0.5 / 4
    assert_true(close_to(d.first_energy, 0.5 * 4 * d.first_amplitude * d.first_amplitude, 1e-9));
    assert_true(close_to(d.first_share, 1, 1e-12));
    assert_true(d.last_frequency > 4.0 / 3 &&
                d.last_frequency < 1.01 * 4 / 3); // towards the bilinear frequency
    assert_true(d.least_damping > 0);
}

// Two masses, the second pressed against the ground by 0.5: the modes of [2 -1; -1 1 + k]. A stiff contact
// only ends the motion of the second mass; the first stays the first, whatever the upper eigenvalue.
struct Stiff {
    double omega = 0, want = 0;
};
Stiff first_mode_on(double k) {
    plm::NonlinearModeOptions o;
    o.hbm.n_harmonics = 3;
    o.mode = 1;
    o.amplitude_min = 0.1, o.amplitude_max = 0.11; // the contact opens at about 0.5
    const auto mode = plm::follow_nonlinear_mode(test::reduce_exactly(test::chain(2, 0, k, 0, 0, 0.5, {1})),
                                                 o, plm::Watch());
    const double trace = 3 + k, determinant = 1 + 2 * k;
    return {mode.branch->points().front().omega,
            std::sqrt(2 * determinant / (trace + std::sqrt(trace * trace - 4 * determinant)))};
}
void stiff_contact_does_not_change_the_mode_asked_for(void **) {
    for (double k : {1.0, 1e3, 1e6, 1e9, 1e12}) {
        const Stiff s = first_mode_on(k);
        assert_true(close_to(s.omega, s.want, 1e-9)); // tolerance of the equations
    }
}

// What the damping takes in a period, pi sum h w (a' C a + b' C b) w h, is what xi gives: 2 xi w M in the
// place of C. The contact does no work over a period.
struct Balance {
    std::size_t points = 0;
    double error = 0, first = 0, least = 1e300, most = 0, share = 1;
};
Balance energy_balance(const exact::Structure &s) {
    plm::NonlinearModeOptions o;
    o.hbm.n_harmonics = 9;
    o.hbm.tolerance = 1e-11;
    o.mode = 1;
    const auto mode = plm::follow_nonlinear_mode(test::reduce_exactly(s), o, plm::Watch());
    Balance b;
    b.points = mode.branch->points().size();
    for (const plm::BranchPoint &p : mode.branch->points()) {
        std::vector<plm::vector<double>> q;
        for (int i = 0; i < s.n; ++i)
            q.push_back(test::displacement(mode.branch->reduced(), p.eta_0, p.eta, i));
        double taken = 0, given = 0;
        for (std::int64_t c = 1; c <= p.eta.cols(); ++c) {
            const double h = static_cast<double>((c + 1) / 2);
            for (int i = 0; i < s.n; ++i) {
                given += 2 * p.damping_ratio * p.omega * h * h * s.mass[i] * q[i][c] * q[i][c];
                for (int j = 0; j < s.n; ++j) taken += h * h * q[i][c] * s.damping[i * s.n + j] * q[j][c];
            }
        }
        b.error = std::max(b.error, std::abs(given / taken - 1));
        b.least = std::min(b.least, p.damping_ratio);
        b.most = std::max(b.most, p.damping_ratio);
    }
    b.first = mode.branch->points().front().damping_ratio;
    b.share = mode.measures.back().closed_share;
    return b;
}
void damping_ratio_balances_the_energy(void **) {
    // C = 2 zeta / w_1 K of the chain without its contact; the closed one: xi = phi' C phi / (2 w) to zeta^2
    const double zeta = 0.002, w1 = 2 * std::sin(M_PI / 10), k = 2;
    const double square = 2 * (1 + 2 * k) / (3 + k + std::sqrt((3 + k) * (3 + k) - 4 * (1 + 2 * k)));
    const double ratio = 2 - square; // (2 - w^2) q_1 = q_2
    const double linear =
        zeta / w1 * (2 - 2 * ratio + ratio * ratio) / (1 + ratio * ratio) / std::sqrt(square);
    const Balance b = energy_balance(test::chain(2, zeta, k, 0, 0, 0.5, {1}));
    std::printf("    %zu points, xi %.3e to %.3e, linear %.3e; balance %.1e\n", b.points, b.least, b.most,
                linear, b.error);
    assert_true(close_to(b.first, linear, 1e-4)); // zeta^2
    assert_true(below(b.error, 1e-7));
    assert_true(b.share < 0.9 && b.most > 1.05 * b.least); // the contact opened, and xi told of it
}

// Harmonics chosen, but no more than `most`: the mode of an oscillator that strikes a stop.
plm::Warnings said_with(int most, double &tail) {
    plm::NonlinearModeOptions o;
    o.hbm.n_harmonics = 0;
    o.hbm.max_harmonics = most;
    o.frequency_hz = 1 / (2 * M_PI);
    o.amplitude_min = 0.5;
    o.amplitude_max = 5;
    const auto mode = plm::follow_nonlinear_mode(
        test::reduce_exactly(test::bilinear_oscillator(0, 3, 1, 0, 0)), o, plm::Watch());
    tail = 0;
    for (const auto &p : mode.branch->points()) tail = std::max(tail, p.harmonic_tail);
    return mode.branch->warnings;
}

void too_few_harmonics_are_said(void **) {
    const double wanted = plm::HbmOptions().allowed_harmonic_error();
    double tail = 0;
    assert_true(said_with(3, tail).has(plm::reason::harmonics_too_few) && tail > wanted);
    assert_true(said_with(60, tail).empty() && tail <= wanted);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(bilinear_frequency_at_every_amplitude),
        cmocka_unit_test(gap_stiffens_as_the_exact_motion_does),
        cmocka_unit_test(preload_keeps_contact_until_it_opens),
        cmocka_unit_test(stiff_contact_does_not_change_the_mode_asked_for),
        cmocka_unit_test(damping_ratio_balances_the_energy),
        cmocka_unit_test(too_few_harmonics_are_said),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
