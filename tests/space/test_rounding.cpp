// Rigid-body motion that contact leaves free, in models whose rows or loads miss it by the digits of a file:
// the same state of rest as without, and a word about it; what is meant stays.
#include "space/rest.hpp"
#include "support/caught.hpp"
#include "support/spring_models.hpp"
#include "support/test.hpp"

namespace {

struct Built {
    plm::Warnings warnings;
    std::shared_ptr<const plm::Model> model;
    explicit Built(const plm::ModelInput &in)
        : model(std::make_shared<const plm::Model>(in, plm::SpaceOptions(), nullptr,
                                                   plm::Watch().keeping(warnings))) {}
    plm::RestState rest() const {
        return *plm::rest_of(*plm::make_contact_space(model, 1.0, 4, plm::Watch()));
    }
    bool says(const char *part) const { return warnings.text().find(part) != std::string::npos; }
};

// Two free chains of four masses 1 and springs 1, end to end, pressed together by 1 from both sides; two rows
// between their ends miss the common motion by `row` to either side, the loads by `load`, relative.
plm::ModelInput pressed_chains(double row, double load) {
    constexpr int n = 4;
    test::Dense stiffness = test::diagonal(2 * n, 0);
    const test::Dense one = test::free_chain(n, 1);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) stiffness[i][j] = stiffness[n + i][n + j] = one[i][j];
    plm::ModelInput in = test::input(test::diagonal(2 * n, 1), stiffness);
    for (double miss : {row, -row}) test::add_pair(in, {0, 0, 0, 1, -(1 + miss), 0, 0, 0}, 2.5);
    in.preload = {1, 0, 0, 0, 0, 0, 0, -(1 + load)};
    return in;
}

// The pairs carry 1 whatever the digits; the least of them that is no longer rounding of doubles is said.
void rounded_rows_and_loads_rest(void **) {
    for (double row : {0.0, 1e-12, 1e-9, 1e-8, 1e-6, 1e-5, 1e-4})
        for (double load : {0.0, 1e-12, 1e-9, 1e-7, -1e-5, 1e-4}) {
            const Built b(pressed_chains(row, load));
            assert_int_equal(b.model->n_rigid(), 2);
            assert_int_equal(b.model->n_unheld(), 1);
            const plm::RestState rest = b.rest();
            const double digits = 10 * row + std::abs(load);
            for (int pair : {0, 1}) assert_true(close_to(rest.force[pair], 0.5, 1e-8 + digits));
            double centre = 0; // of mass: it stays, but for rounding of the loads over what holds it, 1e-10
            for (int i = 0; i < 8; ++i) centre += rest.displacement.at(i);
            assert_true(std::abs(centre) < 1e-4 + digits);
            // the motion that the rows see least is (1 + row^2 / 2, 1): the loads miss that, too
            const bool row_is_said = row > 2e-9,
                       load_is_said = std::max(std::abs(load), row * row / 2) > 2e-9;
            assert_true(b.warnings.has(plm::reason::rounded) == (row_is_said || load_is_said));
            assert_true(b.says("gap rows") == row_is_said && b.says("pre-load") == load_is_said);
        }
}

// A motion of one rigid body on two walls, q = (across, towards them), that lean by `slope` to either side:
// its rows see the motion across by that much, and nothing cancels.
plm::ModelInput on_leaning_walls(double slope) {
    plm::ModelInput in = test::input(test::diagonal(2, 1), test::diagonal(2, 0));
    test::add_pair(in, {slope, 1}, 10);
    test::add_pair(in, {-slope, 1}, 10);
    in.preload = {0, 1};
    return in;
}

void a_small_lever_that_is_meant_holds(void **) {
    for (double slope : {1e-1, 1e-3, 1e-4}) {
        const Built b(on_leaning_walls(slope));
        assert_int_equal(b.model->n_unheld(), 0);
        assert_true(b.warnings.empty());
        const plm::RestState rest = b.rest();
        assert_true(close_to(rest.force[0], 0.5, 1e-8) && close_to(rest.force[1], 0.5, 1e-8));
    }
    const Built flat(on_leaning_walls(1e-7));
    assert_int_equal(flat.model->n_unheld(), 1);
    assert_true(flat.warnings.has(plm::reason::rounded));
    assert_true(close_to(flat.rest().force[0], 0.5, 1e-8));
}

// A pair of nodes whose places differ by the last digit of a file has a moment about the bodies they belong
// to, which no change of its own two coefficients takes off. Each body: a rigid bar of mass 1 and moment of
// inertia 1, q = (deflection, angle) of each; the pair at its middle, on the other one `offset` beside it.
void a_moment_of_rounded_places_is_left_out(void **) {
    for (double offset : {0.0, 1e-8, 1e-6, 1e-4}) {
        plm::ModelInput in = test::input(test::diagonal(4, 1), test::diagonal(4, 0));
        test::add_pair(in, {1, 0, -1, -offset}, 10);
        in.preload = {1, 0, -1, 0};
        const Built b(in);
        assert_int_equal(b.model->n_rigid(), 4);
        assert_int_equal(b.model->n_unheld(), 3);
        const plm::RestState rest = b.rest();
        assert_true(close_to(rest.force[0], 1, 1e-8 + 2 * offset));
        assert_true(std::abs(rest.displacement.at(3)) <= 1e-7 + offset); // nothing turns
    }
}

// Such bars pressed together at three places, -1, 0 and 1, on the other one beside them by parts of `offset`:
// the common angle is not held by that. At the middle the bars hardly move with it, so that there is next to
// nothing to cancel in that row: it is all rows that count.
void places_beside_one_another_hold_no_common_angle(void **) {
    for (double offset : {0.0, 1e-8, 1e-6, 1e-5, 1e-4}) {
        plm::ModelInput in = test::input(test::diagonal(4, 1), test::diagonal(4, 0));
        test::add_pair(in, {1, -1, -1, 1 + offset}, 10);
        test::add_pair(in, {1, 0, -1, -0.7 * offset}, 10);
        test::add_pair(in, {1, 1, -1, -1 + 0.4 * offset}, 10);
        in.preload = {3, 0, -3, 0};
        const Built b(in);
        assert_int_equal(b.model->n_unheld(), 2);
        assert_true(b.warnings.has(plm::reason::rounded) == (offset > 0));
        const plm::RestState rest = b.rest();
        for (double force : rest.force) assert_true(close_to(force, 1, 1e-8 + 10 * offset));
    }
}

// The motion of a body far heavier than the one that the rows join it to is not small because its share of a
// row is.
void masses_may_differ_much(void **) {
    plm::ModelInput in = test::input({{1e13, 0}, {0, 1}}, test::diagonal(2, 0));
    test::add_pair(in, {1, -1}, 10);
    test::add_pair(in, {0, 1}, 10);
    assert_int_equal(Built(in).model->n_unheld(), 0);
}

void a_load_that_does_not_balance_is_named(void **) {
    const Built b(pressed_chains(1e-7, 0.01));
    const Caught e = caught([&] { b.rest(); });
    assert_int_equal(e.status, plm::status::convergence);
    assert_true(e.says("pre-load drives a rigid-body motion that no support and no contact holds"));
    // 0.01 on eight masses that move alike; half a per cent of 2.01
    assert_true(e.says("its resultant is 0.01, 5.0e-03 of its forces") &&
                e.says(", by 7.1e-08 of its terms"));
}

// The mean of the excitation is a load at rest, too.
void a_mean_excitation_is_balanced(void **) {
    plm::ModelInput in = pressed_chains(0, 0);
    in.excitation[0].real = {0.1, 0, 0, 0, 0, 0, 0, -0.1 * (1 + 1e-6)};
    const Built b(in);
    assert_true(b.warnings.has(plm::reason::rounded) && b.says("mean of the excitation"));
    double sum = 0;
    for (int i = 0; i < 8; ++i) sum += b.model->excitation().at(0).real.at(i);
    assert_true(std::abs(sum) < 1e-15);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(rounded_rows_and_loads_rest),
        cmocka_unit_test(a_small_lever_that_is_meant_holds),
        cmocka_unit_test(a_moment_of_rounded_places_is_left_out),
        cmocka_unit_test(places_beside_one_another_hold_no_common_angle),
        cmocka_unit_test(masses_may_differ_much),
        cmocka_unit_test(a_load_that_does_not_balance_is_named),
        cmocka_unit_test(a_mean_excitation_is_balanced),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
