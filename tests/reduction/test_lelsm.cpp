// LELSM (Butcher and Lu 2007) and its updated form with Ritz vectors (AL-Shudeifat and Butcher 2010):
// what the papers state of them, on chains with piecewise-linear springs.
#include "reduction/lelsm.hpp"
#include "reduction/updated_lelsm.hpp"
#include "rival_cases.hpp"
#include "searches/hbm.hpp"

using namespace rival;
namespace basis_kinds = plm::basis_kinds;

namespace {

plm::SelectionRule all_modes(const Scene &s) {
    plm::SelectionRule rule;
    rule.min_hz = s.window.min_hz;
    rule.max_hz = s.window.max_hz;
    rule.below_factor = 3;
    return rule;
}

plm::EquivalentModes modes_of(const Scene &s) {
    return plm::lelsm_modes(*s.full->space(), all_modes(s), plm::Watch());
}

plm::EquivalentMotion motion_of(const Scene &s, double amplitude = 0) {
    const plm::SelectionRule rule = all_modes(s);
    const double middle = M_PI * (s.window.min_hz + s.window.max_hz);
    return plm::equivalent_motion(*s.full->space(), {middle, rule.highest_eigenvalue(), amplitude},
                                  plm::Watch());
}

double dense_frequency(exact::Structure s, double share, std::int64_t mode) {
    for (double &k : s.contact_stiffness) k *= share;
    return std::sqrt(std::max(0.0, test::dense_modes(s, plm::PairStates::all_closed(s.z)).values[mode]));
}

// Butcher and Lu: the equivalent stiffness is the one with the bilinear frequency. Dense eigenproblems over
// all DOFs.
void frequencies_of_the_equivalent_systems_are_the_bilinear_ones(void **) {
    const Scene s = make_scene(test::chain(8, 0.02, 3, 0, 0.01, 0, {1, 5}), 0.17, 0.22);
    const plm::EquivalentModes modes = modes_of(s);
    assert_int_equal(modes.coupling.size(), 8); // 3 x 5 harmonics x 0.22 rad/s holds the whole chain
    for (std::size_t i = 0; i < modes.coupling.size(); ++i) {
        const double open = dense_frequency(s.structure, 0, i), closed = dense_frequency(s.structure, 1, i);
        const double bilinear = 2 * open * closed / (open + closed);
        assert_true(close_to(2 * M_PI * modes.frequency_hz[i], bilinear, 1e-9));
        assert_true(
            close_to(dense_frequency(s.structure, modes.coupling[i], i), bilinear, 1e-8)); // root to 1e-9
        assert_true(modes.coupling[i] > 0 && modes.coupling[i] < 1);
    }
}

void a_rigid_body_mode_of_the_open_system_stays_one(void **) {
    const Scene s = make_scene(test::two_chains(12, 4, 2, false), 1.0, 1.5);
    const plm::EquivalentModes modes = modes_of(s);
    assert_true(modes.frequency_hz[0] == 0 && modes.coupling[0] == 0);
    for (std::size_t i = 1; i < modes.coupling.size(); ++i) assert_true(modes.frequency_hz[i] > 0);
}

// Butcher and Lu: the reduced models represent the dynamics of the full one more accurately than those of
// standard linear transformations.
int n_times_better(const exact::Structure &structure, double omega_min, double omega_max, std::int64_t most) {
    const Scene s = make_scene(structure, omega_min, omega_max);
    const plm::Space &space = *s.full->space();
    const plm::Matrix columns = modes_of(s).columns;
    int better = 0;
    for (std::int64_t n = 1; n <= most; ++n) {
        const PeakError lelsm = error_on(s, span_of(space, columns.columns(0, n))),
                        linear = error_on(s, span_of(space, linear_modes(space, false, n)));
        std::printf("    %d columns: LELSM %.1e in frequency, %.1e in amplitude; linear modes %.1e, %.1e\n",
                    static_cast<int>(n), lelsm.frequency, lelsm.amplitude, linear.frequency,
                    linear.amplitude);
        better += lelsm.frequency < linear.frequency && lelsm.amplitude < linear.amplitude;
    }
    return better;
}
void lelsm_modes_beat_as_many_linear_modes(void **) {
    assert_int_equal(n_times_better(test::chain(4, 0.02, 0.3, 0, 0.01, 0, {3}), 0.34, 0.46, 2), 2);
    assert_int_equal(
        n_times_better(test::chain(8, 0.02, 3, 0, 0.01, 0, {0, 1, 2, 3, 4, 5, 6}), 0.19, 0.26, 4), 4);
}

// On one mass the equivalent motion is harmonic balance with one harmonic, at resonance.
double distance_to_single_harmonic_balance(double gap, double force) {
    Scene s = make_scene(test::bilinear_oscillator(0.05, 2, gap, force, 0.02), 0.9, 1.5);
    const plm::EquivalentMotion motion = motion_of(s);
    plm::HbmOptions o;
    o.n_harmonics = 1;
    const plm::Hbm hbm(s.full->reduced(), s.window.min_hz, s.window.max_hz, o, plm::Watch());
    const auto point = hbm.solve(motion.frequency / (2 * M_PI), nullptr, 0);
    const double amplitude = point->amplitude(0, 0, plm::Measure::half_peak_to_peak, 0);
    return motion.settled ? std::abs(amplitude / std::abs(motion.amplitude[0]) - 1) : 1;
}
void the_equivalent_motion_of_one_mass_is_its_first_harmonic(void **) {
    // shares settle to 1e-6; forces at which there is one solution
    assert_true(below(distance_to_single_harmonic_balance(0, 0.1), 1e-5));
    assert_true(below(distance_to_single_harmonic_balance(0.2, 0.1), 1e-5));
    assert_true(below(distance_to_single_harmonic_balance(0.6, 0.8), 1e-5));
}

double share_for(double gap, double force) {
    return motion_of(make_scene(grounded_chain(gap, force), 0.05, 0.12)).coupling[0];
}
// What the updated form adds to the other one: stiffness that depends on the amplitude where there is a gap.
void equivalent_stiffness_depends_on_the_amplitude_with_a_gap_alone(void **) {
    assert_true(close_to(share_for(0, 1e-6), share_for(0, 1e3), 1e-5)); // shares settle to 1e-6
    assert_true(share_for(1, 1e-4) == 0);                               // does not reach the spring
    assert_true(share_for(1, 0.01) > 1.2 * share_for(1, 0.005));
    assert_true(close_to(share_for(1, 1e3), share_for(0, 1e3), 1e-3)); // the gap is nothing beside the motion
}

void a_given_amplitude_is_the_largest_of_a_pair(void **) {
    const Scene s = make_scene(test::chain(8, 0.02, 3, 0.1, 0.01, 0, {1, 5}), 0.17, 0.22);
    const plm::EquivalentMotion motion = motion_of(s, 0.37);
    assert_true(motion.settled);
    assert_true(
        close_to(std::max(std::abs(motion.amplitude[0]), std::abs(motion.amplitude[1])), 0.37, 1e-12));
}

// Iterations from soft to stiff contact, and the limit: k_n no longer matters to the equivalent stiffness.
struct Settled {
    std::int64_t iterations = 0;
    double spring = 0;
};
Settled settled_motion(double contact_stiffness) {
    const Scene s = make_scene(test::two_chains(40, 9, contact_stiffness, true), 0.3, 0.6);
    const plm::EquivalentMotion motion = motion_of(s);
    return {motion.settled ? motion.iterations : 1000000,
            *std::max_element(motion.spring.begin(), motion.spring.end())};
}
void the_iteration_settles_up_to_rigid_contact(void **) {
    for (double k : {1e-3, 1.0, 300.0, 1e5})
        assert_true(settled_motion(k).iterations <= 30); // measured: 2 to 15
    const Settled stiff = settled_motion(1e6), rigid = settled_motion(1e9);
    assert_true(rigid.iterations <= 30);
    assert_true(close_to(stiff.spring, rigid.spring, 0.02)); // what is left of the gap's own flexibility
}

struct GapErrors {
    std::int64_t n_modes = 0, size = 0;
    PeakError updated, lelsm,
        eight_modes; // lelsm: as many columns; eight_modes: updated ones without Ritz vectors
};
GapErrors errors_with_gap(double gap) {
    const Scene s = make_scene(grounded_chain(gap, 0.01), 0.05, 0.12);
    const plm::Space &space = *s.full->space();
    const auto updated = [&](double below_factor) {
        plm::SelectionRule rule = all_modes(s);
        rule.below_factor = below_factor;
        return plm::updated_lelsm_modes(space, rule, 0, false, plm::Watch());
    };
    const plm::UpdatedModes few = updated(0.8), many = updated(3);
    GapErrors e;
    e.n_modes = few.n_modes;
    const auto reduced = span_of(space, few.columns);
    e.size = reduced->size();
    e.updated = error_on(s, reduced);
    e.lelsm = error_on(s, span_of(space, modes_of(s).columns.columns(0, e.size)));
    e.eight_modes = error_on(s, span_of(space, many.columns.columns(0, 8)));
    std::printf("    gap %g: %d modes and Ritz vectors %.1e in frequency, %.1e in amplitude; LELSM of equal "
                "size %.1e, %.1e; 8 modes alone %.1e, %.1e\n",
                gap, static_cast<int>(e.n_modes), e.updated.frequency, e.updated.amplitude, e.lelsm.frequency,
                e.lelsm.amplitude, e.eight_modes.frequency, e.eight_modes.amplitude);
    return e;
}
// AL-Shudeifat and Butcher: Ritz vectors reduce the number of modes needed and considerably raise accuracy.
// Considerably means here by more than a factor of 10, in frequency and in amplitude; measured are 16 to
// 1000.
void updated_modes_with_ritz_vectors_need_fewer_columns(void **) {
    for (double gap : {0.3, 1.0, 3.0}) {
        const GapErrors e = errors_with_gap(gap);
        assert_int_equal(e.n_modes, 4);
        assert_int_equal(e.size, 5); // the contact forces of all harmonics act on one pair
        assert_true(below(e.updated.frequency, e.lelsm.frequency / 10));
        assert_true(below(e.updated.amplitude, e.lelsm.amplitude / 10));
        assert_true(below(e.updated.frequency, e.eight_modes.frequency / 10));
        assert_true(below(e.updated.amplitude, e.eight_modes.amplitude / 10));
    }
}

// With modes alone, too, the amplitude counts: at a gap that is just reached the spring is hardly there.
void two_updated_modes_beat_those_without_amplitude(void **) {
    const Scene s = make_scene(grounded_chain(3, 0.004), 0.055, 0.08);
    const plm::Space &space = *s.full->space();
    const plm::UpdatedModes updated = plm::updated_lelsm_modes(space, all_modes(s), 0, false, plm::Watch());
    const PeakError u = error_on(s, span_of(space, updated.columns.columns(0, 2))),
                    l = error_on(s, span_of(space, modes_of(s).columns.columns(0, 2)));
    std::printf("    two modes: updated %.1e, %.1e; LELSM %.1e, %.1e\n", u.frequency, u.amplitude,
                l.frequency, l.amplitude);
    assert_true(below(u.frequency, l.frequency) && below(u.amplitude, l.amplitude));
}

std::string argument_without(bool force, bool damping) {
    exact::Structure structure = grounded_chain(1, force ? 0.01 : 0);
    if (!damping) structure.damping.assign(structure.damping.size(), 0.0);
    const Scene s = make_scene(structure, 0.05, 0.12);
    return test::failure_of([&] { build(s, kind(&basis_kinds::lelsm_updated)); }).argument;
}
void nothing_that_sets_an_amplitude_is_refused(void **) {
    assert_string_equal(argument_without(true, false).c_str(), "equivalent_amplitude");
    assert_string_equal(argument_without(false, true).c_str(), "equivalent_amplitude");
    assert_true(argument_without(true, true).empty());
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(frequencies_of_the_equivalent_systems_are_the_bilinear_ones),
        cmocka_unit_test(a_rigid_body_mode_of_the_open_system_stays_one),
        cmocka_unit_test(lelsm_modes_beat_as_many_linear_modes),
        cmocka_unit_test(the_equivalent_motion_of_one_mass_is_its_first_harmonic),
        cmocka_unit_test(equivalent_stiffness_depends_on_the_amplitude_with_a_gap_alone),
        cmocka_unit_test(a_given_amplitude_is_the_largest_of_a_pair),
        cmocka_unit_test(the_iteration_settles_up_to_rigid_contact),
        cmocka_unit_test(updated_modes_with_ritz_vectors_need_fewer_columns),
        cmocka_unit_test(two_updated_modes_beat_those_without_amplitude),
        cmocka_unit_test(nothing_that_sets_an_amplitude_is_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
