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
    test::add_pair(in, {0, 0, 1, 0, 0, -1}, PLM_AUTO_STIFFNESS, 0.1);
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
    in = sound(), in.contact.stiffness[0] = 1;
    assert_true(warns(in, "below 0.1", 1));
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
    test::add_pair(in, row, PLM_AUTO_STIFFNESS, gap);
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
    assert_true(warns(in, "touch no DOF of a translation", 1) && warns(in, "(the first: pair 1, DOF 19)", 1));
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
    assert_true(warns(in, "2 rigid-body modes while the contacts are open, and 1 of them", 1));
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
    assert_true(warns(in, "under the pre-load all 1 pairs are open", 1));
    const std::vector<Finding> list = findings(in);
    assert_true(close_to(with(list, "under the pre-load")->value, -3.0 / (3 * 2e3), 1e-8));
    in.preload[20] = -3;
    assert_true(with(findings(in), "under the pre-load") == nullptr);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(sound_model_has_facts_only),
        cmocka_unit_test(unsound_models_are_found_out),
        cmocka_unit_test(translations_are_what_the_matrices_tell),
        cmocka_unit_test(loose_structures_are_told_from_held_ones),
        cmocka_unit_test(reversed_signs_show),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
