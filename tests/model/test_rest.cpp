// Structures at rest that nothing but contact holds together, against closed forms, however stiff the
// contact.
#include "caught.hpp"
#include "model/rest.hpp"
#include "spring_models.hpp"
#include "support/test.hpp"

namespace {

// Two free chains of n masses, springs 1, end to end; the outer masses are pushed with `left` and `right`.
// One pair joins the ends that face each other, a second one the masses behind them.
plm::ModelInput two_free_chains(int n, int n_pairs, double contact_stiffness, double left, double right) {
    test::Dense stiffness = test::diagonal(2 * n, 0);
    const test::Dense one = test::free_chain(n, 1);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) stiffness[i][j] = stiffness[n + i][n + j] = one[i][j];
    plm::ModelInput in = test::input(test::diagonal(2 * n, 1), stiffness);
    for (int p = 0; p < n_pairs; ++p) {
        std::vector<double> row(2 * n, 0.0);
        row[n - 1 - p] = 1, row[n + p] = -1;
        test::add_pair(in, row, contact_stiffness);
    }
    in.preload.assign(2 * n, 0.0);
    in.preload.front() = left, in.preload.back() = right;
    return in;
}

plm::RestState rest_of(const plm::ModelInput &in) {
    return plm::solve_rest(*plm::make_contact_space(test::build(in), 1.0, 4, plm::Watch()));
}

// u_2 = u_1 + 2 N_1 over the springs of 1 beside the joint, and N_1 + N_2 = 1.
void free_bodies_press_on_each_other(void **) {
    for (int n : {4, 8, 20})
        for (int n_pairs : {1, 2})
            for (double k : {1e-3, 1.0, 1e2, 1e4, 1e5, 1e6, 1e8, 1e10}) {
                const plm::RestState rest = rest_of(two_free_chains(n, n_pairs, k, 1, -1));
                const double first = n_pairs == 1 ? 1 : 1 / (2 + 2 * k);
                // the space is right to 1e-8; displacements to a few eps of n, which k turns into forces
                const double tolerance = 1e-8 + 2e-15 * n * k;
                assert_true(std::abs(rest.force[0] - first) < tolerance);
                if (n_pairs == 2) assert_true(std::abs(rest.force[1] - (1 - first)) < tolerance);
                if (first > tolerance) assert_true(rest.closed == plm::vector<char>(n_pairs, 1));
                assert_true(rest.iterations <= 20);
            }
}

// A load without resultant, and contact that stays open: nothing but rounding acts on the rigid-body motion.
void a_free_body_is_stretched(void **) {
    const int n = 4;
    plm::ModelInput in = test::input(test::diagonal(n, 1), test::free_chain(n, 1));
    test::add_pair(in, {0, 1, -1, 0}, 5, 0.3);
    in.preload = {-0.1, 0, 0, 0.1};
    const plm::RestState rest = rest_of(in);
    assert_true(close_to(rest.displacement[n - 1] - rest.displacement[0], 0.3, 1e-8));
    assert_true(std::abs(rest.displacement[0] + rest.displacement[n - 1]) <
                1e-8); // about the mean position zero
    assert_true(rest.force[0] == 0);
}

void what_nothing_holds_is_refused(void **) {
    for (double k : {1e-3, 1.0, 1e4, 1e10})
        for (double right : {0.0, 1.0}) { // pushed away together; pulled apart
            const double left = right > 0 ? -1 : 1;
            const Caught e = caught([&] { rest_of(two_free_chains(4, 1, k, left, right)); });
            assert_int_equal(e.status, PLM_ERR_CONVERGENCE);
            assert_true(e.says("drives a rigid-body motion"));
        }
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_bodies_press_on_each_other),
        cmocka_unit_test(a_free_body_is_stretched),
        cmocka_unit_test(what_nothing_holds_is_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
