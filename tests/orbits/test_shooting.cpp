// Periodic orbits by shooting: against the tests' own orbits, with multipliers, peaks and the defect as a
// certificate of states that are not periodic.
#include "flows.hpp"
#include "orbits/recorded_motion.hpp"

using namespace test;

namespace {

struct Agreement {
    double state = 1e300, peak = 1e300, defect = 1e300;
    std::size_t n_multipliers = 0;
};
Agreement against_own_orbit(double omega) {
    const exact::Structure s = damped_chain();
    const auto model = flow_model(s);
    plm::ExactFlow flow(model, omega, 1);
    const exact::Orbit want = exact::periodic_orbit(s, omega, {}, 60, 400);
    plm::ShootingOptions o;
    o.transient_periods = 60;
    const std::int64_t n = s.n;
    const plm::PeriodicOrbit got =
        plm::periodic_orbit(flow, {plm::vector<double>(n), plm::vector<double>(n), 0}, o);
    if (!want.converged || !got.converged) return {};
    Matrix rows(n, n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) rows(i, j) = model->dof_row(i)[j];
    const plm::vector<double> peaks = plm::orbit_peaks(flow, got.state, got.period_multiple, rows);
    Agreement a;
    a.state = max_difference(to_dofs(*model, got.state), want.start);
    a.peak = 0;
    for (int i = 0; i < n; ++i) a.peak = std::max(a.peak, std::abs(peaks[i] / want.peak(i) - 1));
    a.defect = plm::periodicity_defect(flow, got.state);
    a.n_multipliers = got.multipliers.size();
    return a;
}
void shooting_finds_the_orbit(void **) {
    for (double omega : {0.2, 0.4, 0.9, 1.5}) {
        const Agreement a = against_own_orbit(omega);
        assert_true(below(a.state, 1e-9));
        assert_true(below(a.peak, 1e-6)); // parabolas through 400 samples on the other side
        assert_true(below(a.defect, 1e-11));
        assert_int_equal(a.n_multipliers, 8);
    }
}

bool is_stable(const plm::PeriodicOrbit &orbit) {
    return std::abs(orbit.multipliers.at(0)) < 1; // the largest
}

// What becomes of a small disturbance is what the multipliers say: here period doubling at 0.9, decay at 0.4.
struct Growth {
    double measured = 0, multiplier = 0;
    bool stable = false;
};
Growth growth(double omega, int periods) {
    const auto model = flow_model(damped_chain());
    plm::ExactFlow flow(model, omega, 1);
    plm::ShootingOptions o;
    o.transient_periods = 60;
    const plm::PeriodicOrbit orbit =
        plm::periodic_orbit(flow, {plm::vector<double>(4), plm::vector<double>(4), 0}, o);
    FlowState x = orbit.state;
    x.y[0] += 1e-6;
    double distance[2];
    for (double &d : distance) { // a decaying part is gone after the first run
        flow.advance(x, x.time + periods * flow.period());
        d = 0;
        for (int j = 0; j < 4; ++j) d += std::pow(x.y[j] - orbit.state.y[j], 2);
    }
    return {std::pow(distance[1] / distance[0], 0.5 / periods), std::abs(orbit.multipliers[0]),
            is_stable(orbit)};
}
void disturbances_grow_by_the_multipliers(void **) {
    const Growth doubling = growth(0.9, 20), decay = growth(0.4, 8);
    assert_true(!doubling.stable && decay.stable);
    assert_true(near(doubling.measured, doubling.multiplier, 1e-3));
    assert_true(near(decay.measured, decay.multiplier, 0.1)); // a complex pair: it turns
}

// Linear oscillator: amplitude, multipliers exp((-zeta +- i wd) T), everything in closed form.
struct Linear {
    double peak = 0, multiplier = 0;
    std::int64_t iterations = 0;
};
Linear linear_orbit() {
    const double omega = 0.8, zeta = 0.05;
    const auto model = flow_model(bilinear_oscillator(zeta, 1, 1e30, 1, 0));
    plm::ExactFlow flow(model, omega, 2.0);
    const plm::PeriodicOrbit orbit = plm::periodic_orbit(flow, {{5}, {5}, 0});
    Matrix row(1, 1);
    row(0, 0) = 1;
    const double want = 2 / std::hypot(1 - omega * omega, 2 * zeta * omega);
    return {std::abs(plm::orbit_peaks(flow, orbit.state, orbit.period_multiple, row)[0] / want - 1),
            std::abs(std::abs(orbit.multipliers[0]) / std::exp(-zeta * flow.period()) - 1), orbit.iterations};
}
void a_linear_orbit_is_found_in_one_step(void **) {
    const Linear l = linear_orbit();
    assert_true(below(l.peak, 1e-13));
    assert_true(below(l.multiplier, 1e-13));
    assert_int_equal(l.iterations, 1);
}

// Impact oscillator past its period doubling: the orbit of one period is unstable, the one of two periods
// not.
struct Doubled {
    double first = 0, second = 0;
    bool converged = false;
};
Doubled period_two() {
    const exact::Structure s = bilinear_oscillator(0.05, 1e4, 0, 1, 0);
    const auto model = flow_model(s);
    for (double omega = 2.4; omega < 5.0; omega += 0.1) {
        plm::ExactFlow flow(model, omega, 1);
        plm::ShootingOptions o;
        o.transient_periods = 200;
        o.period_multiple = 2;
        const plm::PeriodicOrbit two = plm::periodic_orbit(flow, {{-0.3}, {0}, 0}, o);
        if (!two.converged || !is_stable(two)) continue;
        const double once = plm::periodicity_defect(flow, two.state);
        if (once < 1e-3) continue; // an orbit of one period run twice
        return {once, plm::periodicity_defect(flow, two.state, 2), true};
    }
    return {};
}
void orbits_of_several_periods_are_found(void **) {
    const Doubled d = period_two();
    assert_true(d.converged);
    assert_true(d.first > 1e-3);
    assert_true(below(d.second, 1e-10));
}

double defect_of_rest() {
    plm::ExactFlow flow(flow_model(bilinear_oscillator(0.05, 3, 0.2, 1, 0)), 1, 0);
    return plm::periodicity_defect(flow, {{0}, {0}, 0});
}
void rest_has_no_defect(void **) {
    assert_true(defect_of_rest() == 0);
}

void rows_of_another_flow_are_refused(void **) {
    plm::ExactFlow flow(flow_model(bilinear_oscillator(0.05, 3, 0.2, 1, 0)), 1, 1);
    assert_int_equal(failure_of([&] { plm::orbit_peaks(flow, plm::FlowState(), 1, Matrix(1, 2)); }).status,
                     plm::status::argument);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(shooting_finds_the_orbit),
        cmocka_unit_test(disturbances_grow_by_the_multipliers),
        cmocka_unit_test(a_linear_orbit_is_found_in_one_step),
        cmocka_unit_test(orbits_of_several_periods_are_found),
        cmocka_unit_test(rest_has_no_defect),
        cmocka_unit_test(rows_of_another_flow_are_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
