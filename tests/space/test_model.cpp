// The model on its free DOFs: what is kept, what is refused, and the contact stiffness chosen.
#include "support/caught.hpp"
#include "support/spring_models.hpp"
#include "support/test.hpp"

using plm::Model;
using plm::ModelInput;

namespace {

// Two masses, k1 to ground, k2 between, one pair of mass 2 against ground.
ModelInput two_masses(double stiffness = plm::auto_stiffness) {
    ModelInput in = test::input({{2, 0}, {0, 3}}, {{100 + 50, -50}, {-50, 50}});
    test::add_pair(in, {0, 1}, stiffness, 0.25);
    return in;
}

Caught refused(const ModelInput &in) {
    return caught([&] { test::build(in); });
}

void auto_stiffness_of_one_spring(void **) {
    ModelInput in = test::input({{2}}, {{100}});
    test::add_pair(in, {1}, plm::auto_stiffness);
    const auto m = test::build(in);
    assert_true(close_to(m->local_stiffness(), 100, 1e-13));
    assert_true(close_to(m->contact_stiffness()[0], 1000, 1e-13));
    assert_true(m->shift() == 0);
}

void auto_stiffness_of_two_springs_in_series(void **) {
    const auto m = test::build(two_masses());
    const double series = 1 / (1.0 / 100 + 1.0 / 50);
    assert_true(close_to(m->local_stiffness(), series, 1e-12));
    assert_true(close_to(m->contact_stiffness()[0], 10 * series, 1e-12));
    assert_true(m->initial_gap()[0] == 0.25);
    assert_true(close_to(m->responses(plm::Watch())->whole_energies(0)[0], 1 / series, 1e-12));
    assert_true(test::build(two_masses(7))->contact_stiffness()[0] == 7);
}

void fixed_dofs_vanish(void **) {
    ModelInput in = test::input(test::diagonal(3, 1), test::free_chain(3, 10));
    in.fixed = {0};
    test::add_pair(in, {1, 0, -1}, 5);
    in.preload = {100, 0, 3};
    in.excitation[1].real = {1, 2, 3};
    const auto m = test::build(in);
    assert_int_equal(m->n_free(), 2);
    assert_true(m->terms(0).empty());
    assert_true(m->terms(2).size() == 1 && m->terms(2)[0].dof == 1 && m->terms(2)[0].coefficient == 1);
    assert_true(m->preload().at(1) == 3 && m->preload().rows() == 2);
    assert_true(m->excitation().at(1).real.at(0) == 2 && m->excitation().at(1).imag.rows() == 2);
    assert_int_equal(m->gap_rows().matrix().nnz(), 1);
    double all[3];
    m->expand(plm::Field(plm::vector<double>{7, 8}), 0, all);
    const plm::Field back = m->restricted(all);
    assert_true(all[0] == 0 && all[1] == 7 && all[2] == 8 && back.at(0) == 7 && back.at(1) == 8);
}

// A chain of consistent masses, held by fixing its end: what strains nothing is the stiffness.
void mass_and_stiffness_exchanged_are_refused(void **) {
    constexpr int n = 5;
    test::Dense mass = test::diagonal(n, 4);
    for (int i = 0; i + 1 < n; ++i) mass[i][i + 1] = mass[i + 1][i] = 1;
    ModelInput in = test::input(mass, test::free_chain(n, 10));
    in.fixed = {0};
    assert_int_equal(test::build(in)->n_free(), n - 1);
    std::swap(in.mass, in.stiffness);
    const Caught c = refused(in);
    assert_int_equal(c.status, plm::status::matrix);
    assert_true(c.says("mass and stiffness are probably exchanged"));
    // nor where the host has removed what is fixed
    test::Dense held = test::free_chain(n, 10);
    held[0][0] += 10;
    assert_int_equal(refused(test::input(held, mass)).status, plm::status::matrix);
    // a mass that two DOFs have between them alone is none of that, on springs that join them
    const ModelInput inerter = test::input({{1, -1}, {-1, 1}}, {{3, -1}, {-1, 3}});
    assert_int_equal(test::build(inerter)->n_free(), 2);
}

void no_pair_is_a_linear_model(void **) {
    const auto m = test::build(test::input({{2}}, {{100}}));
    assert_int_equal(m->n_pairs(), 0);
    assert_true(m->local_stiffness() == 0);
    assert_int_equal(m->responses(plm::Watch())->energy.cols(), 0);
}

void zero_preload_is_none(void **) {
    ModelInput in = two_masses();
    in.preload = {0, 0};
    assert_false(test::build(in)->has_preload());
}

void wholes_that_make_no_sense_are_refused(void **) {
    ModelInput in = two_masses();
    in.fixed = {1, 0, 1};
    assert_true(refused(in).says("all DOFs are fixed"));

    in = two_masses(), in.fixed = {1};
    Caught c = refused(in);
    assert_int_equal(c.status, plm::status::argument);
    assert_int_equal(c.index, 0);
    assert_true(c.says("contact pair 0") && c.says("fixed DOFs only") && c.argument == "pair");

    in = two_masses(), in.mass = nullptr;
    assert_int_equal(refused(in).status, plm::status::state);
    in = two_masses(), in.stiffness = nullptr;
    assert_true(refused(in).says("PLM_STIFFNESS"));

    in = two_masses(), in.preload = {1, 2, 3};
    c = refused(in);
    assert_int_equal(c.status, plm::status::argument);
    assert_true(c.argument == "preload" && c.says("3 entries"));

    in = two_masses(), in.mass = test::matrix({{1}});
    assert_true(refused(in).argument == "mass");
    in = two_masses(), in.mass = test::matrix({{1, 0}, {0, -1}});
    c = refused(in);
    assert_int_equal(c.status, plm::status::matrix);
    assert_int_equal(c.index, 1);
    in = two_masses(), in.mass = test::matrix({{0, 0}, {0, 0}});
    assert_true(refused(in).says("no free DOF has mass"));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(auto_stiffness_of_one_spring),
        cmocka_unit_test(auto_stiffness_of_two_springs_in_series),
        cmocka_unit_test(fixed_dofs_vanish),
        cmocka_unit_test(mass_and_stiffness_exchanged_are_refused),
        cmocka_unit_test(no_pair_is_a_linear_model),
        cmocka_unit_test(zero_preload_is_none),
        cmocka_unit_test(wholes_that_make_no_sense_are_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
