// The exact flow against closed forms, its own invariants and the independent flow of tests/support.
#include "flows.hpp"
#include <limits>

using namespace test;

namespace {

std::shared_ptr<const plm::FlowModel> oscillator(double zeta, double k_n, double gap, double force,
                                                 double preload = 0) {
    return flow_model(bilinear_oscillator(zeta, k_n, gap, force, preload));
}
FlowState at(double y, double v) {
    return {{y}, {v}, 0};
}

// y'' + 2 zeta y' + y = cos w t from rest.
double linear_error(double zeta, double omega, double t) {
    plm::ExactFlow flow(oscillator(zeta, 1, 1e30, 1), omega, 1);
    FlowState x = at(0, 0);
    flow.advance(x, t);
    double want;
    if (zeta == 0) {
        want = omega == 1 ? 0.5 * t * std::sin(t) : (std::cos(omega * t) - std::cos(t)) / (1 - omega * omega);
    } else {
        const std::complex<double> h = 1.0 / std::complex<double>(1 - omega * omega, 2 * zeta * omega);
        const double wd = std::sqrt(1 - zeta * zeta), a = -h.real(), b = (omega * h.imag() + zeta * a) / wd;
        want = (h * std::polar(1.0, omega * t)).real() +
               std::exp(-zeta * t) * (a * std::cos(wd * t) + b * std::sin(wd * t));
    }
    return std::abs(std::abs(x.y[0]) - std::abs(want)); // the mode's sign is free
}
void linear_oscillator_follows_its_closed_form(void **) {
    assert_true(below(linear_error(0.05, 0.7, 30), 1e-13));
    assert_true(below(linear_error(0, 0.7, 30), 1e-13));
    assert_true(below(linear_error(0, 1, 30), 1e-12)); // undamped resonance: t sin t / 2
    assert_true(below(linear_error(0, 1 + 1e-9, 30), 1e-6));
}

// Free vibration of the bilinear oscillator from (0, 1): half a period of each side, back to the start.
double bilinear_period_error(double k_n) {
    const auto model = oscillator(0, k_n, 0, 0);
    plm::ExactFlow flow(model, 1, 1);
    FlowState x = at(0, 1);
    flow.advance(x, M_PI + M_PI / std::sqrt(1 + k_n));
    return std::max(std::abs(x.y[0]), std::abs(x.v[0] - 1));
}
void bilinear_free_vibration_has_its_period(void **) {
    assert_true(below(bilinear_period_error(3), 1e-13));
    assert_true(below(bilinear_period_error(1e6), 1e-12));
    assert_true(below(bilinear_period_error(1e-6), 1e-13));
}

struct Conserved {
    double energy = 0;
    std::int64_t events = 0, steps = 0;
};
Conserved energy_drift(double k_n) {
    exact::Structure s = chain(6, 0, k_n, 0.1, 0, 0.05, {1, 3, 5});
    const auto model = flow_model(s);
    plm::ExactFlow flow(model, 0.3, 1);
    std::vector<double> q(2 * s.n, 0.0);
    for (int i = 0; i < s.n; ++i) q[i] = 0.3 * i * i / 6.0, q[s.n + i] = i % 2 ? 0.5 : -0.4;
    FlowState x = to_state(*model, s, q);
    const double before = energy(*model, x);
    flow.advance(x, 20 * flow.period());
    return {std::abs(energy(*model, x) / before - 1), flow.n_events(), flow.n_steps()};
}
void energy_is_conserved_over_many_events(void **) {
    for (double k_n : {0.5, 20.0, 1e4}) {
        const Conserved c = energy_drift(k_n);
        std::printf("    k_n = %g: %d events in %d steps, energy drift %.1e\n", k_n, int(c.events),
                    int(c.steps), c.energy);
        assert_true(c.events > 100);
        assert_true(below(c.energy, 5e-12)); // rounding, to the modes of a contact set and back, 1440 times
    }
}

// Chains with uncommon damping, pre-load and gaps, one period in 40 pieces against the test's own flow.
double chain_error(double k_n, double gap, double preload, int periods) {
    exact::Structure s = chain(5, 0.02, k_n, gap, 0.3, preload, {0, 2, 4});
    s.damping[0] += 0.03; // no longer diagonal in the modes
    const double omega = 0.45;
    const auto model = flow_model(s);
    plm::ExactFlow flow(model, omega, 1);
    std::vector<double> q(2 * s.n, 0.0);
    q[4] = 0.7;
    q[7] = -0.2;
    FlowState x = to_state(*model, s, q);
    const exact::Orbit orbit = exact::periodic_orbit(s, omega, q, periods, 40); // marches, then shoots
    for (int k = 0; k < periods; ++k) flow.advance(x, (k + 1) * flow.period());
    plm::ShootingOptions o;
    const plm::PeriodicOrbit mine = plm::periodic_orbit(flow, x, o);
    return orbit.converged && mine.converged ? max_difference(to_dofs(*model, mine.state), orbit.start)
                                             : 1e300;
}
void chains_agree_with_the_independent_flow(void **) {
    assert_true(below(chain_error(2, 0.05, 0, 20), 1e-10));
    assert_true(below(chain_error(50, 0, 0.6, 20), 1e-10));
    assert_true(below(chain_error(0.1, -0.1, 0, 20), 1e-10));
}

// A force turned round is the force half a period later. Also a sweep over forces below zero, as backbones
// and "force_scale" make them, is no matter for the standard library: std::polar() of a negative size is
// undefined.
double turned_force_error(double k_n, double damping) {
    exact::Structure s = chain(5, 0.02, k_n, 0.05, 0.3, 0.1, {0, 2, 4});
    s.damping[0] += damping; // not diagonal in the modes where it is above zero
    const auto model = flow_model(s);
    plm::ExactFlow forth(model, 0.45, 1), back(model, 0.45, -1);
    std::vector<double> q(2 * s.n, 0.0);
    q[4] = 0.7, q[7] = -0.2;
    FlowState x = to_state(*model, s, q), y = x;
    const double half = 0.5 * forth.period();
    x.time = half;
    forth.advance(x, half + 5 * forth.period());
    back.advance(y, 5 * back.period());
    return forth.n_events() > 0 && forth.n_events() == back.n_events()
               ? max_difference(to_dofs(*model, x), to_dofs(*model, y))
               : 1e300;
}
void a_negative_force_is_a_force_half_a_period_later(void **) {
    for (double k_n : {0.5, 50.0})
        for (double damping : {0.0, 0.03})
            assert_true(below(turned_force_error(k_n, damping), 1e-11)); // events to rounding, five periods
}

// A free flight over a stop: the top of the parabola passes u = 0 by `height`, for a time 2 sqrt(2 height).
std::int64_t grazing_events(double height) {
    auto m = std::const_pointer_cast<plm::ReducedModel>(
        std::shared_ptr<const plm::ReducedModel>(reduce_exactly(bilinear_oscillator(0, 100, 0.5, 0, -1))));
    m->lambda = m->lambda_0 = {0}; // thrown up against gravity 1
    m->gap = m->gap_0 = Matrix(1, 1);
    m->gap(0, 0) = m->gap_0(0, 0) = 1;
    m->preload_0 = {-1};
    const auto model = std::make_shared<plm::FlowModel>(m);
    plm::ExactFlow flow(model, 1, 1);
    FlowState x = at(0, std::sqrt(2 * (0.5 + height)));
    flow.advance(x, 2.0);
    return flow.n_events();
}
void grazing_contacts_are_found(void **) {
    assert_int_equal(grazing_events(1e-2), 2);
    assert_int_equal(grazing_events(1e-6), 2);
    assert_int_equal(grazing_events(1e-10), 2);
    assert_int_equal(grazing_events(-1e-10), 0);
    assert_int_equal(grazing_events(-1e-6), 0);
}

// Equal pairs in parallel: one event of all of them, the same motion as one pair of their joint stiffness.
struct Parallel {
    double difference = 0;
    std::int64_t events = 0, single_events = 0;
};
Parallel parallel_pairs(int count, double gap) {
    exact::Structure one = bilinear_oscillator(0.01, 12, gap, 1, 0), many = one;
    many.z = count;
    many.gap_rows.assign(count, 1.0);
    many.contact_stiffness.assign(count, 12.0 / count);
    many.gap.assign(count, gap);
    plm::ExactFlow a(flow_model(one), 0.8, 1), b(flow_model(many), 0.8, 1);
    FlowState x = at(0.3, 0), y = at(0.3, 0);
    a.advance(x, 10 * a.period());
    b.advance(y, 10 * b.period());
    return {std::abs(x.y[0] - y.y[0]) + std::abs(x.v[0] - y.v[0]), b.n_events(), a.n_events()};
}
void simultaneous_events_of_equal_pairs_do_not_hang(void **) {
    for (double gap : {0.0, 0.1}) {
        const Parallel p = parallel_pairs(40, gap);
        assert_true(p.single_events >= 10);
        assert_true(p.events <= 40 * p.single_events);
        assert_true(below(p.difference, 1e-11));
    }
}

// Rest in exact contact without force: u = 0 and u' = 0 for ever.
double resting_motion(double preload) {
    const exact::Structure s = chain(3, 0.01, 5, 0, 0, preload, {0, 1, 2});
    const auto model = flow_model(s);
    plm::ExactFlow flow(model, 1, 0);
    FlowState x{plm::vector<double>(3), plm::vector<double>(3), 0};
    flow.advance(x, 5 * flow.period());
    return preload == 0 ? plm::norm2(3, x.y.data()) + plm::norm2(3, x.v.data()) : 0.0;
}
void pairs_that_rest_at_zero_do_not_hang(void **) {
    assert_true(resting_motion(0) == 0);
    assert_true(resting_motion(0.1) == 0); // starts at zero with acceleration only
    assert_true(resting_motion(-0.1) == 0);
}

double stiff_error(double k_n) {
    exact::Structure s = chain(2, 0.02, k_n, 0.05, 0.3, 0, {1});
    const double omega = 0.5;
    const auto model = flow_model(s);
    plm::ExactFlow flow(model, omega, 1);
    FlowState x{plm::vector<double>(2), plm::vector<double>(2), 0}, y = x;
    for (int k = 1; k <= 4; ++k) flow.advance(x, k * flow.period());
    for (int k = 1; k <= 997; ++k)
        flow.advance(y, 4 * flow.period() * k / 997.0); // other pieces, same motion
    return std::max(std::abs(x.y[0] - y.y[0]), std::abs(x.y[1] - y.y[1]));
}
void stiff_contact_does_not_depend_on_the_pieces(void **) {
    assert_true(below(stiff_error(1e3), 1e-11));
    assert_true(below(stiff_error(1e6), 1e-9));
}

// Two events in every period of the force, which is 2000 times as fast as the structure alone: more than are
// put up with.
void chatter_is_an_error_not_a_hang(void **) {
    auto m = std::make_shared<plm::ReducedModel>(*reduce_exactly(bilinear_oscillator(0, 3, 0, 1, 0)));
    m->excitation = {{2000, m->excitation.at(1)}};
    const auto model = std::make_shared<plm::FlowModel>(std::shared_ptr<const plm::ReducedModel>(m));
    plm::ExactFlow flow(model, 1, 1);
    FlowState x = at(-m->excitation.at(2000).real[0] / 4e6, 0); // no swing of its own
    assert_int_equal(failure_of([&] { flow.advance(x, flow.period()); }).status, plm::status::convergence);
    assert_true(flow.n_events() > 1000);
}

void wrong_input_is_refused(void **) {
    const auto run = [](FlowState x, double t_end) {
        return failure_of([&] {
            plm::ExactFlow flow(oscillator(0, 3, 0, 1), 1, 1);
            flow.advance(x, t_end);
        });
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    assert_int_equal(run({{0, 0}, {0}, 0}, 1).status, plm::status::argument);
    assert_int_equal(run({{nan}, {0}, 0}, 1).status, plm::status::argument);
    assert_int_equal(run({{0}, {0}, 0}, nan).status, plm::status::argument);
    assert_int_equal(run({{0}, {0}, 2}, 1).status, plm::status::argument);
    assert_int_equal(failure_of([] { plm::ExactFlow(oscillator(0, 3, 0, 1), 0, 1); }).status,
                     plm::status::argument);
    const auto model = oscillator(0, 3, 0, 1);
    assert_int_equal(failure_of([&] {
                         model->state({0, 0}, Matrix(1, 2), 1, 0);
                     }).status,
                     plm::status::argument);
    assert_int_equal(failure_of([&] { model->dof_row(1); }).status, plm::status::argument);
}

struct Stopper : plm::Monitor {
    void log(int, const std::string &) override {}
    bool progress(const char *, double) override { return ++calls > 3; }
    int calls = 0;
};
void the_host_can_stop_it(void **) {
    Stopper stopper;
    const Failure f = failure_of([&] {
        plm::ExactFlow flow(oscillator(0, 1e6, 0, 1), 1, 1, plm::Watch(&stopper));
        FlowState x = at(0, 1);
        flow.advance(x, 1000 * flow.period());
    });
    assert_int_equal(f.status, plm::status::cancelled);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(linear_oscillator_follows_its_closed_form),
        cmocka_unit_test(bilinear_free_vibration_has_its_period),
        cmocka_unit_test(energy_is_conserved_over_many_events),
        cmocka_unit_test(chains_agree_with_the_independent_flow),
        cmocka_unit_test(a_negative_force_is_a_force_half_a_period_later),
        cmocka_unit_test(grazing_contacts_are_found),
        cmocka_unit_test(simultaneous_events_of_equal_pairs_do_not_hang),
        cmocka_unit_test(pairs_that_rest_at_zero_do_not_hang),
        cmocka_unit_test(stiff_contact_does_not_depend_on_the_pieces),
        cmocka_unit_test(chatter_is_an_error_not_a_hang),
        cmocka_unit_test(wrong_input_is_refused),
        cmocka_unit_test(the_host_can_stop_it),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
