// Structures at rest that nothing but contact holds together, against closed forms, however stiff the
// contact.
#include "linalg/lapack.hpp"
#include "space/rest.hpp"
#include "support/caught.hpp"
#include "support/spring_models.hpp"
#include "support/test.hpp"
#include <random>

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
    return *plm::rest_of(*plm::make_contact_space(test::build(in), 1.0, 4, plm::Watch()));
}

// u_2 = u_1 + 2 N_1 over the springs of 1 beside the joint, and N_1 + N_2 = 1.
void free_bodies_press_on_each_other(void **) {
    for (int n : {4, 8, 20})
        for (int n_pairs : {1, 2})
            for (double k : {1e-3, 1.0, 1e2, 1e4, 1e5, 1e6, 1e8, 1e10}) {
                const plm::RestState rest = rest_of(two_free_chains(n, n_pairs, k, 1, -1));
                const double first = n_pairs == 1 ? 1 : 1 / (2 + 2 * k);
                // the space is right to 1e-8; displacements to some tens of eps of n, which k turns into
                // forces: by the kernels of other processors up to 2.4e-15 n k was seen
                const double tolerance = 1e-8 + 1e-14 * n * k;
                assert_true(std::abs(rest.force[0] - first) < tolerance);
                if (n_pairs == 2) assert_true(std::abs(rest.force[1] - (1 - first)) < tolerance);
                if (first > tolerance) assert_true(rest.states == plm::PairStates::all_closed(n_pairs));
                assert_true(rest.iterations <= 40); // 25 where the second force is rounding, too
            }
}

// A load without resultant, and contact that stays open: nothing but rounding acts on the rigid-body motion.
void a_free_body_is_stretched(void **) {
    const int n = 4;
    plm::ModelInput in = test::input(test::diagonal(n, 1), test::free_chain(n, 1));
    test::add_pair(in, {0, 1, -1, 0}, 5, 0.3);
    in.preload = {-0.1, 0, 0, 0.1};
    const plm::RestState rest = rest_of(in);
    assert_true(close_to(rest.displacement.at(n - 1) - rest.displacement.at(0), 0.3, 1e-8));
    // about the mean position zero, but for the load's rounding over what holds the rigid body, 1e-10
    assert_true(std::abs(rest.displacement.at(0) + rest.displacement.at(n - 1)) < 1e-6);
    assert_true(rest.force[0] == 0);
}

void what_nothing_holds_is_refused(void **) {
    for (double k : {1e-3, 1.0, 1e4, 1e10})
        for (double right : {0.0, 1.0}) { // pushed away together; pulled apart
            const double left = right > 0 ? -1 : 1;
            const Caught e = caught([&] { rest_of(two_free_chains(4, 1, k, left, right)); });
            assert_int_equal(e.status, plm::status::convergence);
            assert_true(e.says("drives a rigid-body motion"));
        }
}

// Rest is made first: coordinates, and forces of pairs that press, that are apart, and that touch with no
// force at all, some of them about zero displacement with no gap. These come out on either side of zero, step
// by step.
void pairs_that_touch_exactly(void **) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> entry(-1, 1);
    const std::int64_t m = 12, z = 9;
    for (int model = 0; model < 200; ++model)
        for (double k : {1e-2, 1.0, 1e4, 1e8}) {
            plm::vector<double> lambda(m), eta(m), load(m);
            plm::Matrix gap(z, m);
            for (std::int64_t j = 0; j < m; ++j) {
                lambda[j] = std::pow(10, 3 * entry(random)), eta[j] = entry(random);
                load[j] = lambda[j] * eta[j];
                for (std::int64_t i = 0; i < z; ++i) gap(i, j) = entry(random);
            }
            plm::Contact contact;
            contact.stiffness.assign(z, k), contact.initial_gap.assign(z, 0.0);
            for (std::int64_t i = 0; i < z; ++i) {
                double along = 0;
                for (std::int64_t j = 0; j < m; ++j) along += gap(i, j) * eta[j];
                const double force = i % 3 == 0 ? 0.5 : 0;
                if (i == 8) gap(i, m - 1) -= along / eta[m - 1]; // touches where it was made
                contact.initial_gap[i] = i == 8 ? 0 : along - force / k + (i % 3 == 1 ? 0.1 : 0);
                for (std::int64_t j = 0; j < m; ++j) load[j] += gap(i, j) * force;
            }
            const plm::StaticState rest = plm::solve_static({lambda, gap, load, contact});
            assert_true(rest.iterations <= 30);
            double worst = 0;
            for (std::int64_t j = 0; j < m; ++j)
                worst = std::max(worst, std::abs(rest.coordinates[j] - eta[j]));
            // lambda over six decades, springs up to five beyond them: some 1e-16 of those ratios, and of the
            // 1e3 / 1e-3 between coordinates what is left in u
            assert_true(below(worst, 1e-12 * (1e3 + k)));
            for (std::int64_t i = 0; i < z; ++i)
                assert_true(below(std::abs(rest.penetration[i] - (i % 3 == 0   ? 0.5 / k
                                                                  : i % 3 == 1 ? -0.1
                                                                               : 0)),
                                  3e-11 * (1 + 1 / k)));
        }
}

// M = G G^T of a rank below its order, without a row of zeros; a chain held at both ends whose outer masses a
// pair joins. Returns the largest error of the displacements, relative, over `n_models` of them.
double rest_error_without_full_mass(int n_models) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> entry(-1, 1);
    double worst = 0;
    for (int model = 0; model < n_models; ++model) {
        const int n = 3 + model % 6, rank = 1 + model % (n - 1);
        std::vector<double> g(n * rank), load(n);
        for (double &v : g) v = entry(random);
        for (double &v : load) v = entry(random);
        test::Dense mass = test::diagonal(n, 0), stiffness = test::free_chain(n, 2e4);
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j)
                for (int k = 0; k < rank; ++k) mass[i][j] += g[i * rank + k] * g[j * rank + k];
        stiffness[0][0] += 2e4, stiffness[n - 1][n - 1] += 2e4;
        plm::ModelInput in = test::input(mass, stiffness);
        std::vector<double> row(n, 0.0);
        row[0] = 1, row[n - 1] = -1;
        test::add_pair(in, row, 2e4);
        in.preload.assign(load.begin(), load.end());
        const plm::RestState rest = rest_of(in);
        for (bool closed : {false, true}) { // one of them is true
            plm::Matrix k(n, n);
            plm::vector<double> x(load.begin(), load.end());
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) k(i, j) = stiffness[i][j] + (closed ? 2e4 * row[i] * row[j] : 0);
            plm::RealLu lu;
            lu.factor(k);
            lu.solve(x.data(), 1, n);
            if ((x[0] - x[n - 1] > 0) != closed) continue;
            double size = 0, error = 0;
            for (int i = 0; i < n; ++i) {
                size = std::max(size, std::abs(x[i]));
                error = std::max(error, std::abs(rest.displacement.at(i) - x[i]));
            }
            if (!(error <= worst * size)) worst = error / size; // NaN is the worst
        }
    }
    return worst;
}
// Rest is a matter of K alone. To the rounding of its solution.
void rest_does_not_depend_on_the_mass(void **) {
    assert_true(below(rest_error_without_full_mass(60), 1e-10));
}

// A mass on a spring so soft that the stiffness is singular to working precision: solved as if it were free,
// though there is no rigid-body mode.
void what_hardly_holds_is_at_rest(void **) {
    bool seen = false;
    for (double soft = 1e-10; soft > 1e-20; soft /= 3) {
        plm::ModelInput in = test::input(test::diagonal(3, 1), {{2, -1, 0}, {-1, 2, 0}, {0, 0, soft}});
        test::add_pair(in, {1, -1, 0}, 5, 0.3);
        in.preload = {-0.1, 0.1, 0};
        const auto model = test::build(in);
        seen = seen || (model->shift() > 0 && model->n_rigid() == 0);
        const plm::RestState rest = rest_of(in);
        assert_true(close_to(rest.displacement.at(1) - rest.displacement.at(0), 0.2 / 3, 1e-6));
    }
    assert_true(seen); // else this shows nothing
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_bodies_press_on_each_other),  cmocka_unit_test(a_free_body_is_stretched),
        cmocka_unit_test(what_nothing_holds_is_refused),    cmocka_unit_test(pairs_that_touch_exactly),
        cmocka_unit_test(rest_does_not_depend_on_the_mass), cmocka_unit_test(what_hardly_holds_is_at_rest),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
