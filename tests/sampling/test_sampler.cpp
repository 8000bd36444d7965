// The sampler as a whole: which mode dominates, which sweep follows, that its space is accurate enough, and
// its errors.
#include "sampling/mode_match.hpp"
#include "sampling/reference_system.hpp"
#include "sampling/sample_selection.hpp"
#include "sampling/sampler.hpp"
#include "small_models.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>

using plm::LinearSystem;
using plm::Sampler;
using plm::SamplerOptions;

namespace {

std::shared_ptr<const Sampler> run(const exact::Structure &s, const SamplerOptions &o = {},
                                   plm::Monitor *monitor = nullptr) {
    return std::make_shared<Sampler>(test::make_model(s), o, plm::Watch(monitor));
}

exact::Structure pressed_chains(double force, int n_pairs = 9) { // on the free ends, against each other
    exact::Structure s = test::two_chains(40, n_pairs, 300, true);
    s.preload[39] = force;
    s.preload[79] = -force;
    return s;
}

plm::PairStates all(int z, bool closed) {
    return closed ? plm::PairStates::all_closed(z) : plm::PairStates::all_open(z);
}

exact::Structure forced_in_mode(int j) { // F = M phi_j of the open system: no other mode responds
    exact::Structure s = test::two_chains(40, 9, 300, true);
    const plm::SymmetricEigen modes = test::dense_modes(s, all(9, false));
    for (int i = 0; i < s.n; ++i) s.force[i] = s.mass[i] * modes.vectors(i, j);
    return s;
}

SamplerOptions with_mode(LinearSystem system, std::int64_t mode) {
    SamplerOptions o;
    o.system = system;
    o.mode = mode;
    return o;
}

double worst_mode_error(LinearSystem system) { // modes by number against the dense eigenproblem
    const exact::Structure s = test::two_chains(40, 9, 300, true);
    const plm::SymmetricEigen dense = test::dense_modes(s, all(9, system == LinearSystem::sliding));
    double worst = 0;
    for (int j = 0; j < 6; ++j) {
        const auto sampler = run(s, with_mode(system, j + 1));
        const double want = plm::to_hz(dense.values[j]);
        worst = std::max(worst, std::abs(sampler->dominant()[0].frequency_hz - want) / want);
    }
    return worst;
}

// B phi against `sign` times the dense mode
double dv_difference(const Sampler &sampler, const exact::Structure &s, int mode, double sign) {
    const plm::SymmetricEigen dense =
        test::dense_modes(s, all(s.z, sampler.dominant()[0].system == LinearSystem::sliding));
    const auto &dv = sampler.dominant()[0].mode_penetration;
    double worst = 0;
    for (int p = 0; p < s.z; ++p) {
        double want = 0;
        for (int i = 0; i < s.n; ++i) want += s.gap_rows[p * s.n + i] * dense.vectors(i, mode - 1);
        worst = std::max(worst, std::abs(dv[p] - sign * want));
    }
    return worst;
}

double dv_error(const Sampler &sampler, const exact::Structure &s, int mode) { // up to sign
    return std::min(dv_difference(sampler, s, mode, 1), dv_difference(sampler, s, mode, -1));
}

bool has_duplicates(const Sampler &sampler) {
    const auto &samples = sampler.samples();
    for (std::size_t i = 0; i < samples.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (samples[i].states == samples[j].states) return true;
    return false;
}

void modes_by_number_equal_the_dense_ones(void **) {
    assert_true(below(worst_mode_error(LinearSystem::open), 1e-9));
    assert_true(below(worst_mode_error(LinearSystem::sliding), 1e-6));
    const exact::Structure s = test::two_chains(40, 9, 300, true);
    assert_true(below(dv_error(*run(s, with_mode(LinearSystem::sliding, 3)), s, 3), 1e-5));
}

void the_space_covers_all_harmonics_of_the_window(void **) {
    SamplerOptions o;
    o.n_harmonics = 7;
    const auto sampler = run(pressed_chains(2), o);
    assert_true(sampler->space()->highest_frequency >= 2 * M_PI * 7 * 1.1 * sampler->window().max_hz);
    assert_true(sampler->space()->error_estimate <= 1e-7);
}

void the_responding_mode_is_proposed(void **) {
    SamplerOptions o;
    o.system = LinearSystem::open;
    const auto sampler = run(forced_in_mode(4), o);
    assert_int_equal(sampler->dominant()[0].mode, 5);
    assert_true(near(sampler->dominant()[0].participation, 1, 1e-10));
    o.mode = 2; // named by the analyst, though it does not respond
    assert_true(near(run(forced_in_mode(4), o)->dominant()[0].participation, 0, 1e-10));
}

void the_search_range_limits_the_proposal(void **) {
    const plm::SymmetricEigen modes = test::dense_modes(test::two_chains(40, 9, 300, true), all(9, false));
    SamplerOptions o;
    o.system = LinearSystem::open;
    o.search_min_hz = plm::to_hz(modes.values[5]) * 0.999;
    o.search_max_hz = plm::to_hz(modes.values[8]) * 1.001;
    const auto mode = run(test::two_chains(40, 9, 300, true), o)->dominant()[0].mode;
    assert_in_range(mode, 6, 9);
    o = SamplerOptions();
    o.system = LinearSystem::open;
    o.mode_frequency_hz = plm::to_hz(modes.values[7]) * 1.0001;
    assert_int_equal(run(test::two_chains(40, 9, 300, true), o)->dominant()[0].mode, 8);
}

void the_reference_system_follows_the_contact_at_rest(void **) {
    const auto closed = run(pressed_chains(50)), open = run(pressed_chains(-50));
    const auto n_closed = [](const Sampler &s) { return s.rest().states.n_closed(); };
    assert_true(2 * n_closed(*closed) > 9 && closed->dominant()[0].system == LinearSystem::sliding);
    assert_true(n_closed(*open) == 0 && open->dominant()[0].system == LinearSystem::open);
}

// Without pre-load and gap: the open system, as no pair is closed at rest; but the sliding one where contact
// alone holds the body.
void without_preload_the_reference_system_is_the_one_that_can_serve(void **) {
    const auto crack = run(test::breathing_crack());
    assert_true(crack->dominant()[0].system == LinearSystem::open);
    assert_true(run(test::two_chains(40, 9, 300, true))->dominant()[0].system == LinearSystem::open);
    exact::Structure loose = test::breathing_crack(); // without its ligament
    loose.stiffness = {0, 0, 0, 2e4};
    assert_true(run(loose)->dominant()[0].system == LinearSystem::sliding);
    // In the sliding mode some pairs of the crack open while others close, which no half cycle shows.
    const auto sliding = run(test::breathing_crack(), with_mode(LinearSystem::sliding, 1));
    const double good = plm::half_cycle_agreement(*crack->space(), crack->dominant()[0]),
                 bad = plm::half_cycle_agreement(*sliding->space(), sliding->dominant()[0]);
    assert_true(good > 1.5 * bad);
}

// The exact motion, at steps of 2 % over twice the window, responds most inside it.
void the_window_of_a_breathing_crack_holds_its_resonance(void **) {
    const exact::Structure s = test::breathing_crack();
    const auto sampler = run(s);
    double best = 0, at = 0;
    std::vector<double> guess;
    for (double hz = 0.7 * sampler->window().min_hz; hz < 1.4 * sampler->window().max_hz; hz *= 1.02) {
        const exact::Orbit o = exact::periodic_orbit(s, 2 * M_PI * hz, guess, 2, 32);
        if (!o.converged) continue;
        guess = o.start;
        if (o.peak(1) > best) best = o.peak(1), at = hz;
    }
    std::printf("    resonance %.4f Hz, window [%.4f, %.4f] Hz\n", at, sampler->window().min_hz,
                sampler->window().max_hz);
    assert_true(at > 1.01 * sampler->window().min_hz && at < sampler->window().max_hz / 1.01);
}

void the_sweep_starts_from_rest_with_preload_and_from_the_static_offset_without(void **) {
    const auto pressed = run(pressed_chains(2)), loose = run(test::two_chains(40, 9, 300, true));
    assert_true(pressed->sweeps()[0].offset_is_rest && !loose->sweeps()[0].offset_is_rest);
    assert_true(pressed->sweeps()[0].offset == pressed->rest().penetration);
    assert_true(*std::max_element(loose->sweeps()[0].offset.begin(), loose->sweeps()[0].offset.end()) < 0);
    assert_int_equal(pressed->sweeps()[0].samples.size(), 10); // Z + 1
    assert_int_equal(loose->sweeps()[0].samples.size(), 10);
    assert_false(has_duplicates(*pressed) || has_duplicates(*loose));
    assert_true(pressed->samples().size() > 4 && pressed->samples().size() <= 8);
}

void further_dominant_modes_add_their_sweeps(void **) {
    SamplerOptions o;
    o.complements = false;
    o.n_samples = 10;
    const std::size_t alone = run(pressed_chains(2), o)->samples().size();
    o.extra.push_back({LinearSystem::open, 5});
    const auto sampler = run(pressed_chains(2), o);
    assert_int_equal(sampler->sweeps().size(), 2);
    assert_int_equal(sampler->dominant()[1].mode, 5);
    assert_true(sampler->samples().size() > alone && !has_duplicates(*sampler));
}

// The open structure floats: its one rigid-body mode counts, but is not proposed.
void rigid_body_modes_count_but_are_not_proposed(void **) {
    const exact::Structure s = test::two_chains(40, 9, 300, false);
    SamplerOptions o;
    o.system = LinearSystem::open;
    const auto proposed = run(s, o);
    assert_true(proposed->dominant()[0].mode > 1 && proposed->dominant()[0].frequency_hz > 0);
    assert_true(below(dv_error(*run(s, with_mode(LinearSystem::open, 2)), s, 2), 1e-8));
}

void without_excitation_the_lowest_flexible_mode_is_taken_with_a_warning(void **) {
    exact::Structure s = test::two_chains(40, 9, 300, true);
    std::fill(s.force.begin(), s.force.end(), 0.0);
    test::Recorder recorder;
    const auto sampler = run(s, SamplerOptions(), &recorder);
    assert_int_equal(sampler->dominant()[0].mode, 1);
    assert_true(!recorder.warnings.empty());
}

// Else the samples, taken from one end of the sweep to the other, hang on an eigensolver's whim.
void a_mode_moves_along_the_load_whatever_sign_it_comes_with(void **) {
    for (int mode = 1; mode <= 6; ++mode) {
        const exact::Structure s = forced_in_mode(mode - 1); // phi . F = 1 with the sign of the dense mode
        exact::Structure other = s;
        for (double &f : other.force) f = -f;
        const auto along = run(s, with_mode(LinearSystem::open, mode)),
                   against = run(other, with_mode(LinearSystem::open, mode));
        assert_true(below(dv_difference(*along, s, mode, 1), 1e-5));
        assert_true(below(dv_difference(*against, s, mode, -1), 1e-5));
    }
}

void two_runs_agree_to_the_last_bit(void **) {
    const auto a = run(pressed_chains(2)), b = run(pressed_chains(2));
    assert_true(a->dominant()[0].coordinates == b->dominant()[0].coordinates);
    assert_true(a->window().min_hz == b->window().min_hz &&
                a->sweeps()[0].thresholds == b->sweeps()[0].thresholds);
}

test::Failure failure_with(void (*change)(SamplerOptions &)) {
    SamplerOptions o;
    change(o);
    return test::failure_of([&] { run(test::bilinear_oscillator(0.01, 8, 0, 1, 0), o); });
}

void options_that_do_not_fit_one_another_or_the_model_are_refused(void **) {
    const struct {
        void (*change)(SamplerOptions &);
        const char *argument;
    } cases[] = {
        {[](SamplerOptions &o) { o.mode = 2; }, "mode"}, // one DOF has one mode
        {[](SamplerOptions &o) { o.window_min_hz = 2, o.window_max_hz = 1; }, "window_max_hz"},
        {[](SamplerOptions &o) { o.window_min_hz = 1, o.window_max_hz = 1; }, "window_max_hz"},
        {[](SamplerOptions &o) { o.window_max_hz = 1; }, "window_min_hz"},
        {[](SamplerOptions &o) { o.search_min_hz = 1; }, "search_max_hz"},
        {[](SamplerOptions &o) { o.search_min_hz = 70, o.search_max_hz = 80; }, "search_max_hz"},
    };
    for (const auto &c : cases) {
        const test::Failure f = failure_with(c.change);
        assert_true(f.thrown);
        assert_int_equal(f.status, plm::status::argument);
        assert_string_equal(f.argument.c_str(), c.argument);
    }
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(modes_by_number_equal_the_dense_ones),
        cmocka_unit_test(the_space_covers_all_harmonics_of_the_window),
        cmocka_unit_test(the_responding_mode_is_proposed),
        cmocka_unit_test(the_search_range_limits_the_proposal),
        cmocka_unit_test(the_reference_system_follows_the_contact_at_rest),
        cmocka_unit_test(without_preload_the_reference_system_is_the_one_that_can_serve),
        cmocka_unit_test(the_window_of_a_breathing_crack_holds_its_resonance),
        cmocka_unit_test(the_sweep_starts_from_rest_with_preload_and_from_the_static_offset_without),
        cmocka_unit_test(further_dominant_modes_add_their_sweeps),
        cmocka_unit_test(rigid_body_modes_count_but_are_not_proposed),
        cmocka_unit_test(without_excitation_the_lowest_flexible_mode_is_taken_with_a_warning),
        cmocka_unit_test(a_mode_moves_along_the_load_whatever_sign_it_comes_with),
        cmocka_unit_test(two_runs_agree_to_the_last_bit),
        cmocka_unit_test(options_that_do_not_fit_one_another_or_the_model_are_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
