// Harmonic balance at the edges of its range: nothing to do, nothing to damp, nothing to hold, many
// harmonics, odd units.
#include "contact/trig_polynomial.hpp"
#include "support/small_solver.hpp"
#include "support/test.hpp"
#include <algorithm>

using plm::HbmOptions;
using test::solver;

namespace {

using Model = std::shared_ptr<const plm::ReducedModel>;

double half_range(const plm::ReducedModel &m, const plm::BranchPoint &p, int dof) {
    const auto q = test::displacement(m, p.eta_0, p.eta, dof);
    const plm::ValueRange range = plm::trig_range(q.data(), p.eta.cols() / 2);
    return 0.5 * (range.maximum - range.minimum);
}

struct Still {
    std::int32_t reason = 0;
    double motion = 0, mean = 0;
};
Still without_force(double preload) {
    const Model m = test::reduce_exactly(test::bilinear_oscillator(0.02, 3, 0, 1, preload));
    HbmOptions o;
    o.force_scale = 0;
    const auto branch = solver(m, o, 0.5, 2).sweep();
    Still s;
    s.reason = branch->end_reason;
    for (const auto &p : branch->points()) s.motion = std::max(s.motion, half_range(*m, p, 0));
    s.mean = m->vectors.formed().at(0, 0) * branch->points().back().eta_0[0];
    return s;
}
void without_force_nothing_moves(void **) {
    const Still loose = without_force(0), pressed = without_force(0.8), pulled = without_force(-0.8);
    assert_int_equal(loose.reason, plm::reason::range_end);
    assert_int_equal(pressed.reason, plm::reason::range_end);
    assert_true(near(loose.motion, 0, 0) && near(loose.mean, 0, 0));
    // some roundings of the mean, as many as the machine's products make
    assert_true(near(pressed.motion, 0, 1e-14) && near(pressed.mean, 0.8 / 4, 1e-14)); // k + k_n = 4
    assert_true(near(pulled.motion, 0, 1e-14) && near(pulled.mean, -0.8, 1e-14));
}

// An undamped oscillator off its resonances against the exact orbit.
double undamped_error(double omega) {
    const exact::Structure s = test::bilinear_oscillator(0, 3, 0.2, 1, 0);
    const Model m = test::reduce_exactly(s);
    HbmOptions o;
    o.n_harmonics = 40;
    const auto branch = solver(m, o, 0.5 * omega, 2 * omega).solve(omega / (2 * M_PI), nullptr, 0);
    const plm::BranchPoint &p = branch->points()[0];
    const auto q = test::displacement(*m, p.eta_0, p.eta, 0);
    const plm::TrigValue v = plm::evaluate_trig(q.data(), 40, 0.0);
    const exact::Orbit orbit = exact::periodic_orbit(s, omega, {v.value, omega * v.slope}, 0, 2000);
    const plm::ValueRange range = plm::trig_range(q.data(), 40);
    const double peak = std::max(std::abs(range.maximum), std::abs(range.minimum));
    return orbit.converged ? std::abs(peak / orbit.peak(0) - 1) : 1e300;
}
void undamped_response_is_exact_off_resonance(void **) {
    assert_true(below(undamped_error(2.5), 1e-6));
    assert_true(below(undamped_error(4.0), 1e-6));
}

// A free mass on a unilateral spring under its weight, shaken gently: it never lifts off and is linear.
double gentle_shaking_error(plm::NonlinearUnknowns unknowns) {
    exact::Structure s = test::bilinear_oscillator(0, 4, 0, 0.01, 1.0);
    s.stiffness = {0};
    s.damping = {0.1};
    const auto m = test::reduce_exactly(s);
    m->lambda = m->lambda_0 = {0};
    HbmOptions o;
    o.unknowns = unknowns;
    const double omega = 1.7;
    const auto branch = solver(m, o, 1, 3).solve(omega / (2 * M_PI), nullptr, 0);
    const double want = 0.01 / std::hypot(4 - omega * omega, 0.1 * omega);
    return std::abs(half_range(*m, branch->points()[0], 0) / want - 1);
}
void a_mass_held_by_contact_alone_rests_on_it(void **) {
    assert_true(below(gentle_shaking_error(plm::NonlinearUnknowns::modal), 1e-10));
    assert_true(below(gentle_shaking_error(plm::NonlinearUnknowns::gaps), 1e-10));
}

std::vector<double> amplitudes_over_harmonics() {
    const Model m = test::reduce_exactly(test::chain(4, 0.05, 5, 0, 1.0, 0.3, {1, 3}));
    std::vector<double> a;
    for (int h : {1, 2, 3, 5, 8, 13, 21, 34, 50}) {
        HbmOptions o;
        o.n_harmonics = h;
        const auto branch = solver(m, o, 0.2, 1).solve(0.6 / (2 * M_PI), nullptr, 0);
        a.push_back(half_range(*m, branch->points()[0], 3));
    }
    return a;
}
void one_to_fifty_harmonics_converge_to_one_answer(void **) {
    const std::vector<double> a = amplitudes_over_harmonics();
    assert_true(close_to(a[a.size() - 2], a.back(), 1e-5)); // H = 34 against 50: kinks, error of order H^-3
    assert_true(close_to(a[3], a.back(), 1e-1));
}

// The same chain in other units: mass and stiffness times mu, time the same, force times mu lambda, length
// times lambda.
double unit_error(double mu, double lambda) {
    const exact::Structure s = test::chain(5, 0.03, 8, 0.02, 0.3, 0.2, {1, 3, 4});
    exact::Structure t = s;
    for (double &v : t.mass) v *= mu;
    for (double &v : t.stiffness) v *= mu;
    for (double &v : t.damping) v *= mu;
    for (double &v : t.contact_stiffness) v *= mu;
    for (double &v : t.gap) v *= lambda;
    for (double &v : t.force) v *= mu * lambda;
    for (double &v : t.preload) v *= mu * lambda;
    const Model a = test::reduce_exactly(s), b = test::reduce_exactly(t);
    HbmOptions o;
    o.n_harmonics = 7;
    o.tolerance = 1e-11;
    double worst = 0;
    for (double omega : {0.6, 1.1, 1.5}) {
        const auto one = solver(a, o, 0.3, 2).solve(omega / (2 * M_PI), nullptr, 0);
        const auto other = solver(b, o, 0.3, 2).solve(omega / (2 * M_PI), nullptr, 0);
        const double want = half_range(*a, one->points()[0], 4), got = half_range(*b, other->points()[0], 4);
        worst = std::max(worst, std::abs(got / lambda / want - 1));
    }
    return worst;
}
void units_do_not_matter(void **) {
    assert_true(below(unit_error(1e-3, 1e3), 1e-9)); // m-kg-s against mm-t-s
    assert_true(below(unit_error(3.7e11, 2.9e-7), 1e-9));
}

// The force grows through the moment of first touch: the amplitude has no jump there.
double largest_jump_through_grazing() {
    const Model m = test::reduce_exactly(test::bilinear_oscillator(0.05, 1e3, 1.0, 1, 0));
    double last = 0, jump = 0,
           touch = 1 / std::hypot(1 - 0.64, 2 * 0.05 * 0.8); // amplitude per force when open
    for (int i = -20; i <= 20; ++i) {
        HbmOptions o;
        o.n_harmonics = 9;
        o.force_scale = (1 + 1e-4 * i) / touch;
        const auto branch = solver(m, o, 0.4, 1.6).solve(0.8 / (2 * M_PI), nullptr, 0);
        const double a = half_range(*m, branch->points()[0], 0);
        if (i > -20) jump = std::max(jump, std::abs(a - last));
        last = a;
    }
    return jump;
}
void grazing_is_passed_without_a_jump(void **) {
    assert_true(below(largest_jump_through_grazing(), 1e-3));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(without_force_nothing_moves),
        cmocka_unit_test(undamped_response_is_exact_off_resonance),
        cmocka_unit_test(a_mass_held_by_contact_alone_rests_on_it),
        cmocka_unit_test(one_to_fifty_harmonics_converge_to_one_answer),
        cmocka_unit_test(units_do_not_matter),
        cmocka_unit_test(grazing_is_passed_without_a_jump),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
