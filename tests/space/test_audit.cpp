// The audit states facts of a sound model and finds what is wrong with an unsound one.
#include "space/audit.hpp"
#include "support/spring_models.hpp"
#include "support/test.hpp"
#include <algorithm>

using plm::Finding;
using plm::ModelInput;

namespace {

ModelInput sound() {
    test::Dense k = test::free_chain(6, 1e4);
    k[0][0] += 1e4;
    ModelInput in = test::input(test::diagonal(6, 0.5), k);
    test::add_pair(in, {0, 0, 1, 0, 0, -1}, plm::auto_stiffness, 0.1);
    in.damping.beta = 1e-5;
    in.excitation[1].real = {0, 0, 0, 0, 0, 1};
    return in;
}

std::vector<Finding> findings(const ModelInput &in) {
    return plm::audit(*test::build(in));
}

const Finding *with(const std::vector<Finding> &list, const char *words) {
    const auto found = std::find_if(
        list.begin(), list.end(), [&](const Finding &f) { return f.text.find(words) != std::string::npos; });
    return found == list.end() ? nullptr : &*found;
}

bool warns(const ModelInput &in, const char *words, int severity) {
    const std::vector<Finding> list = findings(in);
    const Finding *f = with(list, words);
    if (!f || f->severity != severity)
        for (const Finding &x : list) std::printf("    %d %s\n", x.severity, x.text.c_str());
    return f && f->severity == severity;
}

void sound_model_has_facts_only(void **) {
    const std::vector<Finding> list = findings(sound());
    for (const Finding &f : list) {
        if (f.severity) std::printf("    %s\n", f.text.c_str());
        assert_int_equal(f.severity, 0);
    }
    assert_true(close_to(with(list, "cannot be told")->value, 3.0, 1e-14)); // a spring to the ground within K
    assert_true(close_to(with(list, "of the local stiffness")->value, 10, 1e-9));
    assert_true(with(list, "no rigid-body mode") != nullptr);
}

void unsound_models_are_found_out(void **) {
    ModelInput in = sound();
    in.damping.beta = 0;
    assert_true(warns(in, "no damping", 1));
    in = sound(), in.excitation.clear();
    assert_true(warns(in, "no harmonic excitation", 1));
    in = sound(), in.contact.initial_gap[0] = -0.1;
    assert_true(warns(in, "interference", 1));
    in = sound(), test::add_pair(in, {0, 0, 1, 0, 0, -1}, 1e4);
    assert_true(warns(in, "repeat", 2));
    in = sound(), in.contact.stiffness[0] = 1e9;
    assert_true(warns(in, "small loops", 1));
    in = sound(), in.contact.stiffness[0] = 100;
    assert_true(warns(in, "below 0.1", 1));
    in.contact.stiffness[0] = 0.01; // a million times too soft
    assert_true(warns(in, "below 0.1", 2));
    in = sound(), in.gap_coefficient[1] = -0.5;
    assert_true(warns(in, "do not sum to zero", 1));
    in = sound(), in.mass = test::matrix(test::diagonal(6, 0.5e14));
    assert_true(warns(in, "units", 2));
    test::Dense m = test::diagonal(6, 0.5);
    m[4][4] = 0;
    in = sound(), in.mass = test::matrix(m);
    assert_true(warns(in, "no mass", 1));
    in = sound(), in.fixed = {5};
    assert_true(warns(in, "acts on fixed DOFs only: move it", 1));
}

// Cantilever of n elements, two DOFs per node (deflection, slope), its support left to the caller.
ModelInput beam(int n) {
    constexpr double h = 0.1, EI = 2e3, mass_per_length = 0.7;
    const double k[4][4] = {{12, 6 * h, -12, 6 * h},
                            {6 * h, 4 * h * h, -6 * h, 2 * h * h},
                            {-12, -6 * h, 12, -6 * h},
                            {6 * h, 2 * h * h, -6 * h, 4 * h * h}};
    const double m[4][4] = {{156, 22 * h, 54, -13 * h},
                            {22 * h, 4 * h * h, 13 * h, -3 * h * h},
                            {54, 13 * h, 156, -22 * h},
                            {-13 * h, -3 * h * h, -22 * h, 4 * h * h}};
    test::Dense mass = test::diagonal(2 * n + 2, 0), stiffness = mass;
    for (int e = 0; e < n; ++e)
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                stiffness[2 * e + i][2 * e + j] += EI / (h * h * h) * k[i][j];
                mass[2 * e + i][2 * e + j] += mass_per_length * h / 420 * m[i][j];
            }
    ModelInput in = test::input(mass, stiffness);
    in.damping.beta = 1e-5;
    in.excitation[1].real.assign(static_cast<std::size_t>(in.n_dof), 0.0);
    in.excitation[1].real[static_cast<std::size_t>(in.n_dof) - 2] = 1;
    return in;
}

void touch(ModelInput &in, std::int64_t dof, double direction, double gap = 0) {
    std::vector<double> row(static_cast<std::size_t>(in.n_dof), 0.0);
    row[static_cast<std::size_t>(dof)] = direction;
    test::add_pair(in, row, plm::auto_stiffness, gap);
}

// The mass along a translation is that of the whole structure, supports included: length times mass per
// length.
void translations_are_what_the_matrices_tell(void **) {
    ModelInput in = beam(10);
    in.fixed = {0, 1};
    touch(in, 20, 1);
    std::vector<Finding> list = findings(in);
    assert_true(close_to(with(list, "translation of DOFs 0, 2, 4, ... (2 per node)")->value, 0.7, 1e-12));
    assert_true(with(list, "off by one") == nullptr);
    touch(in, 19, 1, 0.1); // a slope
    assert_true(warns(in, "touch no DOF of a translation", 2) && warns(in, "(the first: pair 1, DOF 19)", 2));
    // three uncoupled chains, DOFs 0, 3, 6, ... the first of them: three translations, one of them light
    test::Dense k = test::diagonal(12, 0), m = test::diagonal(12, 0.5);
    for (int i = 0; i + 3 < 12; ++i) k[i][i] += 2, k[i + 3][i + 3] += 2, k[i + 3][i] -= 2, k[i][i + 3] -= 2;
    for (int i = 2; i < 12; i += 3) m[i][i] = 0.25;
    in = test::input(m, k), in.fixed = {0, 1, 2};
    list = findings(in);
    assert_true(close_to(with(list, "DOFs 1, 4, 7")->value, 2, 1e-12));
    assert_true(close_to(with(list, "DOFs 2, 5, 8")->value, 1, 1e-12));
    assert_true(warns(in, "differs between the translations, 1 to 2", 1));
    // the matrices of one that is held already, by a spring, do not tell
    k[0][0] += 1, k[1][1] += 1, k[2][2] += 1;
    in = test::input(m, k);
    assert_true(warns(in, "cannot be told", 0));
}

void loose_structures_are_told_from_held_ones(void **) {
    ModelInput in = sound(); // a pair between two masses of one body
    in.stiffness = test::matrix(test::free_chain(6, 1e4));
    assert_true(warns(
        in, "1 rigid-body modes while the contacts are open, and 1 of them whatever contact closes", 1));
    in = beam(10);
    touch(in, 20, 1, 0.1); // a stop holds the deflection there, not the rotation about it
    assert_true(warns(in, "2 rigid-body modes while the contacts are open, and 1 of them", 2));
    touch(in, 0, -1);
    assert_true(warns(in, "no pre-load presses the contacts together", 1));
    in.preload.assign(22, 0.0);
    in.preload[20] = 1, in.preload[0] = -1;
    assert_true(warns(in, "closed contacts can hold them", 0));
    in = beam(10), in.fixed = {0, 1};
    touch(in, 20, 1, 0.1);
    assert_true(warns(in, "no rigid-body mode", 0));
}

void reversed_signs_show(void **) {
    ModelInput in = beam(10);
    in.fixed = {0, 1};
    touch(in, 20, -1);
    assert_true(warns(in, "motion of DOF 20 in its negative direction closes pair 0", 0));
    in.preload.assign(22, 0.0);
    in.preload[20] = 3; // lifts the tip by F L^3 / (3 EI)
    assert_true(warns(in, "under the pre-load all 1 pairs are open", 2));
    in.contact.initial_gap[0] = 0.1; // away from a stop that it did not touch
    assert_true(warns(in, "under the pre-load all 1 pairs are open", 1));
    in.contact.initial_gap[0] = 0;
    const std::vector<Finding> list = findings(in);
    assert_true(close_to(with(list, "under the pre-load")->value, -3.0 / (3 * 2e3), 1e-8));
    in.preload[20] = -3;
    assert_true(with(findings(in), "under the pre-load") == nullptr);
}

// A chain of six masses with its pair near the tip, which the force moves by how_far gaps at the lowest
// resonance.
ModelInput driven(double how_far) {
    ModelInput in = sound();
    in.gap_coefficient = {-1, 1}, in.gap_dof = {4, 5}, in.gap_row = {0, 0};
    in.contact.initial_gap[0] = 0.1;
    const double k = 1e4, m = 0.5, theta = M_PI / 13; // of the lowest mode: sin((i + 1) theta) at mass i
    const double omega = 2 * std::sqrt(k / m) * std::sin(theta / 2), zeta = 0.5 * in.damping.beta * omega;
    double norm = 0;
    for (int i = 0; i < 6; ++i) norm += m * std::pow(std::sin((i + 1) * theta), 2);
    const double tip = std::sin(6 * theta), moved = std::sin(6 * theta) - std::sin(5 * theta);
    const double amplitude = tip * moved / norm / (2 * zeta * omega * omega); // of the gap, for a unit force
    in.excitation[1].real[5] = how_far * 0.1 / std::abs(amplitude);
    return in;
}

// The linear response of one mode in closed form says how much of the gap a force takes up; the other modes
// add some to it.
void gaps_that_never_close_are_told(void **) {
    for (double part : {1e-6, 0.5}) {
        assert_true(warns(driven(part), "no gap closes", 1));
        assert_true(close_to(with(findings(driven(part)), "no gap closes")->value, part, 0.02));
    }
    assert_true(with(findings(driven(1.05)), "no gap closes") == nullptr);
    ModelInput in = driven(0.5); // closed by a pre-load, or without a gap, every motion switches
    in.preload = {0, 0, 0, 0, 0, 1e4};
    assert_true(with(findings(in), "no gap closes") == nullptr);
    in.preload = {0, 0, 0, 0, 0, 0.07 * 1e4}; // a gap of 0.1 less 0.07
    assert_true(with(findings(in), "no gap closes") == nullptr);
    in = driven(1e-6), in.contact.initial_gap[0] = 0;
    assert_true(with(findings(in), "no gap closes") == nullptr);
    in = driven(1e-6), in.damping.beta = 0; // without damping nothing bounds the motion
    assert_true(with(findings(in), "no gap closes") == nullptr);
    in = driven(0.5), in.excitation[3] = in.excitation[1]; // harmonics add up
    assert_true(with(findings(in), "no gap closes")->value > 0.5);
}

void excitation_of_no_low_mode_is_told(void **) {
    ModelInput in = beam(12); // ten modes of bending below the first of a stiff spring beside it
    in.fixed = {0, 1};
    touch(in, 24, 1, 0.1);
    assert_true(warns(in, "elastic modes of the open structure the excitation moves the one at", 0));
    // the beam's matrices with a mass on a spring, which no motion of the beam reaches
    test::Dense k = test::diagonal(13, 1e4), m = test::diagonal(13, 1);
    for (int i = 0; i + 1 < 12; ++i)
        k[i][i] += 1e4, k[i + 1][i + 1] += 1e4, k[i][i + 1] -= 1e4, k[i + 1][i] -= 1e4;
    k[12][12] = 1e9;
    in = test::input(m, k);
    in.damping.beta = 1e-5;
    test::add_pair(in, {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, plm::auto_stiffness, 0.1);
    in.excitation[1].real.assign(13, 0.0);
    in.excitation[1].real[12] = 1;
    assert_true(warns(in, "the excitation moves none of the 10 lowest elastic modes", 1));
    in.excitation[1].real[12] = 0, in.excitation[1].imag.assign(13, 0.0), in.excitation[1].imag[3] = 1;
    assert_true(with(findings(in), "moves none of") == nullptr);
    // a force on a mass so large that its acceleration is given drives the rest all the same
    k = test::free_chain(6, 1e4), m = test::diagonal(6, 0.5);
    m[0][0] = 1e7;
    in = test::input(m, k);
    in.damping.beta = 1e-5;
    test::add_pair(in, {0, 0, 1, 0, 0, -1}, plm::auto_stiffness, 1e-3);
    in.excitation[1].real = {1e7, 0, 0, 0, 0, 0};
    assert_true(with(findings(in), "moves none of") == nullptr);
}

// Three DOFs per node, as the matrix has them, and a pair that was counted with two.
void pairs_of_mixed_components_are_told(void **) {
    test::Dense k = test::diagonal(30, 0);
    for (int i = 0; i + 3 < 30; ++i) k[i][i] += 2, k[i + 3][i + 3] += 2, k[i + 3][i] -= 2, k[i][i + 3] -= 2;
    ModelInput in = test::input(test::diagonal(30, 0.5), k);
    in.fixed = {0, 1, 2};
    in.damping.beta = 1e-5;
    const auto join = [&](std::int64_t a, std::int64_t b) {
        std::vector<double> row(30, 0.0);
        row[static_cast<std::size_t>(a)] = 1, row[static_cast<std::size_t>(b)] = -1;
        test::add_pair(in, row, plm::auto_stiffness, 0.1);
    };
    join(3 * 2 + 1, 3 * 9 + 1);
    assert_true(with(findings(in), "were they counted") == nullptr);
    join(2 * 2 + 1, 2 * 9 + 1); // DOFs 5 and 19
    assert_true(
        warns(in, "(the first: pair 1, DOFs 5 and 19) join component 2 of one node to component 1", 1));
}

// Bricks' nodes have three DOFs; here the springs of a row of masses, alike in x, y and z.
ModelInput row_of_nodes(int nodes) {
    test::Dense k = test::diagonal(3 * nodes, 0), m = test::diagonal(3 * nodes, 0.5);
    for (int i = 0; i + 3 < 3 * nodes; ++i)
        k[i][i] += 1e4, k[i + 3][i + 3] += 1e4, k[i + 3][i] -= 1e4, k[i][i + 3] -= 1e4;
    ModelInput in = test::input(m, k);
    in.damping.beta = 1e-5;
    in.excitation[1].real.assign(static_cast<std::size_t>(3 * nodes), 0.0);
    for (int x = 0; x < 3; ++x) in.excitation[1].real[static_cast<std::size_t>(3 * nodes - 3 + x)] = 1;
    return in;
}

void row_of(ModelInput &in, std::int64_t a, double on_a, std::int64_t b, double on_b) {
    std::vector<double> row(static_cast<std::size_t>(in.n_dof), 0.0);
    row[static_cast<std::size_t>(a)] = on_a, row[static_cast<std::size_t>(b)] = on_b;
    test::add_pair(in, row, plm::auto_stiffness, 0.1);
}

// One node against a wall is not a pair of nodes; two nodes with two normals are one that was meant
// otherwise.
void oblique_walls_are_no_pairs_of_nodes(void **) {
    ModelInput in = row_of_nodes(6);
    in.fixed = {0, 1, 2};
    row_of(in, 12, 0.8, 14, -0.6);
    assert_true(with(findings(in), "do not sum to zero") == nullptr);
    row_of(in, 12, 0.8, 9, -0.6);
    assert_true(warns(in, "1 two-DOF gap rows do not sum to zero", 1));
    // the matrices do not tell the nodes: a direction is taken for one, other numbers are not
    in = sound();
    in.gap_coefficient = {0.8, -0.6};
    assert_true(with(findings(in), "do not sum to zero") == nullptr);
}

// Supports left in the matrices as a number on the diagonal: held, named, and without a mode.
void supports_left_on_the_diagonal_are_held_and_named(void **) {
    test::Dense k = test::diagonal(18, 0), m = test::diagonal(18, 0.5);
    for (int i = 0; i + 3 < 18; ++i)
        k[i][i] += 1e4, k[i + 3][i + 3] += 1e4, k[i + 3][i] -= 1e4, k[i][i + 3] -= 1e4;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 18; ++j) k[i][j] = k[j][i] = i == j ? 666 : 0;
    for (int i = 0; i < 3; ++i) m[i][i] = 1;
    ModelInput in = test::input(m, k), fixed = row_of_nodes(6);
    in.damping = fixed.damping, in.excitation = fixed.excitation;
    fixed.fixed = {0, 1, 2};
    for (ModelInput *model : {&in, &fixed}) row_of(*model, 15, 1, 9, -1);
    assert_true(warns(in, "3 DOFs (the first: DOF 0) are coupled to nothing", 1));
    assert_true(warns(in, plm::format("%.6g Hz", std::sqrt(666.0) / (2 * M_PI)).c_str(), 1));
    const auto model = test::build(in), right = test::build(fixed);
    assert_int_equal(model->n_free(), 15);
    const plm::StructureModes found = model->lowest_modes(6), want = right->lowest_modes(6);
    for (std::size_t j = 0; j < 6; ++j) assert_true(close_to(found.values[j], want.values[j], 1e-12));
    in.preload.assign(18, 0.0), in.preload[1] = 1; // loaded: it moves
    assert_int_equal(test::build(in)->n_free(), 16);
    in.damping.modal_ratio = {0.01, 0.02}; // by the number of a mode, which would be another
    assert_int_equal(test::build(in)->n_free(), 18);
}

void diagonals_added_up_twice_are_told(void **) {
    test::Dense k = test::diagonal(18, 0), twice = k;
    for (int i = 0; i + 3 < 18; ++i)
        k[i][i] += 1e4, k[i + 3][i + 3] += 1e4, k[i + 3][i] -= 1e4, k[i][i + 3] -= 1e4;
    twice = k;
    for (int i = 0; i < 18; ++i) twice[i][i] *= 2;
    for (const test::Dense *stiffness : {&k, &twice}) {
        ModelInput in = test::input(test::diagonal(18, 0.5), *stiffness);
        row_of(in, 15, 1, 9, -1);
        const std::vector<Finding> list = findings(in);
        const Finding *told = with(list, "added up twice");
        assert_true((told != nullptr) == (stiffness == &twice));
        assert_true(!told || told->severity == 2);
    }
    // two masses on springs to the ground and to one another are meant so
    ModelInput in = test::input(test::diagonal(2, 1), {{2, -1}, {-1, 2}});
    test::add_pair(in, {1, -1}, 10, 0.1);
    assert_true(with(findings(in), "added up twice") == nullptr);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(sound_model_has_facts_only),
        cmocka_unit_test(unsound_models_are_found_out),
        cmocka_unit_test(translations_are_what_the_matrices_tell),
        cmocka_unit_test(loose_structures_are_told_from_held_ones),
        cmocka_unit_test(reversed_signs_show),
        cmocka_unit_test(gaps_that_never_close_are_told),
        cmocka_unit_test(excitation_of_no_low_mode_is_told),
        cmocka_unit_test(pairs_of_mixed_components_are_told),
        cmocka_unit_test(oblique_walls_are_no_pairs_of_nodes),
        cmocka_unit_test(supports_left_on_the_diagonal_are_held_and_named),
        cmocka_unit_test(diagonals_added_up_twice_are_told),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
