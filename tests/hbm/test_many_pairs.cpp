// Hundreds of pairs: a first solution is found beside a resonance, and where steps are dear harmonics are
// limited and the curve says so.
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "hbm/start.hpp"
#include "support/small_solver.hpp"
#include "support/test.hpp"
#include <cmath>
#include <vector>

namespace {

// A cantilever with a crack at each of n joints of its slabs, the pairs spread over the height of the
// section: a slab turns about its ligament when the crack is open, about the pairs when it is closed.
exact::Structure cracked_slabs(int n, int pairs_of_crack, double damping_ratio, double stiffness) {
    exact::Structure s;
    s.n = n, s.z = n * pairs_of_crack;
    s.mass.assign(n, 1);
    s.stiffness.assign(n * n, 0);
    for (int i = 0; i < n; ++i) {
        s.stiffness[i + i * n] += 1;
        if (i == 0) continue;
        s.stiffness[(i - 1) * (n + 1)] += 1;
        s.stiffness[i + (i - 1) * n] -= 1, s.stiffness[i - 1 + i * n] -= 1;
    }
    s.damping = s.stiffness;
    for (double &c : s.damping) c *= 2 * damping_ratio / 0.1; // at 0.1 rad/s
    s.gap_rows.assign(s.z * n, 0);
    for (int i = 0; i < n; ++i)
        for (int p = 0; p < pairs_of_crack; ++p) {
            const double height = -0.35 + 1.35 * (p + 0.5) / pairs_of_crack + 0.01 * std::sin(7.0 * i + p);
            double *row = &s.gap_rows[(i * pairs_of_crack + p) * n];
            row[i] = height;
            if (i > 0) row[i - 1] = -height;
        }
    s.contact_stiffness.assign(s.z, stiffness / pairs_of_crack);
    s.gap.assign(s.z, 0);
    s.force.assign(n, 0);
    s.force[n - 1] = 0.1;
    return s;
}

void a_first_solution_is_found_with_hundreds_of_pairs(void **) {
    const auto m = test::reduce_exactly(cracked_slabs(20, 15, 0.002, 10));
    plm::HbmOptions o = test::by_harmonics();
    o.n_harmonics = 5;
    for (double omega : {0.25, 0.3}) { // between and beside resonances of the open and of the closed cracks
        const auto system = plm::make_system(m, o);
        plm::vector<double> x(system->size()), r(system->size());
        const plm::StartOutcome out =
            plm::find_start(*system, *m, o, omega, false, plm::Watch(), x, plm::StartPaths::affordable);
        system->residual(x.data(), omega, r.data()); // of the problem asked for: no damping is left in it
        const double size = plm::norm2(system->size(), r.data()) / system->residual_scale();
        const bool switches = system->indicator().n_switching == m->n_pairs();
        assert_true(out.converged);
        assert_true(below(size, 1e-6));
        assert_true(switches);
    }
}

void harmonics_are_no_more_than_a_curve_affords(void **) {
    plm::ReducedModel large, small;
    large.lambda.assign(150, 1.0), small.lambda.assign(10, 1.0);
    large.contact.stiffness.assign(2000, 1.0), small.contact.stiffness.assign(2000, 1.0);
    large.contact.initial_gap.assign(2000, 0.0), small.contact.initial_gap.assign(2000, 0.0);
    plm::HbmOptions given;
    given.n_harmonics = 30;
    const plm::HbmOptions of_large = plm::with_affordable_harmonics(large, {}),
                          of_small = plm::with_affordable_harmonics(small, {}),
                          of_given = plm::with_affordable_harmonics(large, given);
    assert_true(of_large.harmonics_by_cost && of_large.max_harmonics < 15 && of_large.max_harmonics >= 5);
    assert_true(!of_small.harmonics_by_cost && of_small.max_harmonics == plm::HbmOptions().max_harmonics);
    assert_true(!of_given.harmonics_by_cost && of_given.n_harmonics == 30);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_first_solution_is_found_with_hundreds_of_pairs),
        cmocka_unit_test(harmonics_are_no_more_than_a_curve_affords),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
