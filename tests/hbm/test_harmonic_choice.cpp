// How many harmonics: none of the excitation is lost, no point keeps too few in silence, the struck part
// counts beside the driven one, and many are reached from few.
#include "hbm/harmonic_choice.hpp"
#include "reduction/basis.hpp"
#include "sampling/small_models.hpp"
#include "searches/phase_resonance.hpp"
#include "support/small_solver.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <vector>

using plm::HbmOptions;
using plm::Measure;
using test::solver;

namespace {

using Reduced = std::shared_ptr<const plm::ReducedModel>;
using BranchPtr = std::shared_ptr<const plm::Branch>;

// --- harmonics of the excitation

Reduced driven_at(int harmonic) {
    auto m =
        test::reduce_exactly(test::bilinear_oscillator(0.02, 3, 100, 0.1, 0)); // the stop is out of reach
    m->excitation[harmonic].real.assign(1, 0.3);
    m->excitation[harmonic].imag.assign(1, 0.0);
    m->excitation[harmonic + 2].real.assign(1, 0.0); // a load taken back
    m->excitation[harmonic + 2].imag.assign(1, 0.0);
    return m;
}

void a_load_that_the_harmonics_do_not_reach_is_refused(void **) {
    const Reduced m = driven_at(7);
    HbmOptions few = test::by_harmonics(), capped = few;
    few.n_harmonics = 6;
    capped.max_harmonics = 6;
    const auto of_solve = test::failure_of([&] { solver(m, few, 0.5, 2).solve(0.1, nullptr, 0); }),
               of_sweep = test::failure_of([&] { solver(m, few, 0.5, 2).sweep(); }),
               of_backbones = test::failure_of([&] { solver(m, few, 0.5, 2).find_backbones(0); }),
               of_capped = test::failure_of([&] { solver(m, capped, 0.5, 2).sweep(); });
    for (const auto &f : {of_solve, of_sweep, of_backbones}) {
        assert_int_equal(f.status, plm::status::argument);
        assert_string_equal(f.argument.c_str(), "n_harmonics");
    }
    assert_int_equal(of_capped.status, plm::status::argument);
    assert_string_equal(of_capped.argument.c_str(), "max_harmonics");
}

void chosen_harmonics_begin_at_the_excitation(void **) {
    const Reduced m = driven_at(7);
    const double omega = 0.31;
    const BranchPtr b = solver(m, test::by_harmonics(), 0.2, 0.5).solve(omega / (2 * M_PI), nullptr, 0);
    const plm::BranchPoint &p = b->points()[0];
    const bool reached = p.eta.cols() >= 14;
    // linear oscillator: |q| = F / |1 - w^2 + 2 i zeta w|
    const double w = 7 * omega, exact = 0.3 / std::hypot(1 - w * w, 0.04 * w),
                 found = reached ? std::hypot(p.eta(0, 12), p.eta(0, 13)) : 0;
    assert_true(reached);
    assert_true(below(std::abs(found / exact - 1), 1e-9)); // rounding
}

// --- what cannot be had is said

// Free flight between impacts that lose nothing: harmonic balance converges slowly, if at all.
void too_few_harmonics_are_said(void **) {
    const Reduced m = test::reduce_exactly(test::bilinear_oscillator(5e-7, 1e9, 0, 1, 0));
    const BranchPtr b = solver(m, test::by_harmonics(), 1.7, 2.1).solve(1.9 / (2 * M_PI), nullptr, 0);
    const HbmOptions o = test::by_harmonics();
    const bool missed = b->points()[0].harmonic_error > o.allowed_harmonic_error(),
               said = b->warnings.has(plm::reason::harmonics_too_few),
               where = b->warnings.text().find("1 of 1 points") != std::string::npos &&
                       b->warnings.text().find("0.302394 Hz") != std::string::npos;
    assert_true(missed && said && where);

    const Reduced easy = test::reduce_exactly(test::bilinear_oscillator(0.01, 3, 1.0, 0.1, 0));
    const BranchPtr good = solver(easy, test::by_harmonics(), 0.6, 1.8).sweep();
    const bool wolf = !good->warnings.empty();
    HbmOptions capped = test::by_harmonics();
    capped.max_harmonics = 4;
    const BranchPtr poor = solver(easy, capped, 0.6, 1.8).sweep();
    std::int64_t over = 0;
    for (const auto &p : poor->points()) over += p.harmonic_error > capped.allowed_harmonic_error();
    const std::string count =
        plm::format("at %d of %d points", static_cast<int>(over), static_cast<int>(poor->points().size()));
    const bool counted = over > 0 && poor->warnings.text().find(count) != std::string::npos,
               remedied = poor->warnings.text().find("raise max_harmonics (4)") != std::string::npos;
    assert_false(wolf);
    assert_true(counted && remedied);
}

// --- the struck part beside the driven one

// Two masses, weakly coupled: one is driven and moves, the other one hits a stop and moves little.
Reduced struck(double contact_stiffness, std::shared_ptr<const plm::Basis> &keep) {
    exact::Structure s;
    s.n = 2, s.z = 1;
    s.mass = {1, 1};
    s.stiffness = {1e4 + 100, -100, -100, 1.21e4 + 100};
    s.damping = s.stiffness;
    for (double &c : s.damping) c *= 1e-3;
    s.gap_rows = {1, 0};
    s.contact_stiffness = {contact_stiffness};
    s.gap = {0};
    s.force = {0, 1};
    const auto model = test::make_model(s);
    const auto sampler = std::make_shared<const plm::Sampler>(model, plm::SamplerOptions(), plm::Watch());
    keep = std::make_shared<const plm::Basis>(model, sampler, nullptr, plm::BasisOptions(), plm::Watch());
    return keep->reduced();
}

struct Share {
    double estimate = 0, at_dof = 0, truth = 0, whole = 0;
};
Share share_at_the_struck_mass(double contact_stiffness) {
    std::shared_ptr<const plm::Basis> basis;
    const Reduced m = struck(contact_stiffness, basis);
    HbmOptions few = test::by_harmonics(), many = few;
    few.n_harmonics = 10, many.n_harmonics = 60;
    const double hz = 17.6;
    const BranchPtr coarse = solver(m, few, 90, 130).solve(hz, nullptr, 0),
                    fine = solver(m, many, 90, 130).solve(hz, coarse.get(), 0);
    plm::BranchPoint p = coarse->points()[0];
    const plm::MeasuredHarmonics next = plm::measure_harmonics(m, few, p);
    Share s;
    s.estimate = p.harmonic_error;
    s.at_dof = plm::harmonic_error_at(*m, p, next.change, 0, Measure::half_peak_to_peak, 0);
    for (const std::int64_t dof : {0, 1}) {
        const auto before = coarse->coefficients(0, dof), after = fine->coefficients(0, dof);
        double change = 0, size = 0;
        for (std::size_t k = 1; k < after.size(); ++k) {
            change = std::hypot(change, after[k] - (k < before.size() ? before[k] : 0));
            size = std::hypot(size, after[k]);
        }
        (dof == 0 ? s.truth : s.whole) = change / size;
    }
    std::printf("    struck: estimated %.1e, true %.1e; driven: true %.1e\n", s.estimate, s.truth, s.whole);
    return s;
}
void errors_at_the_struck_part_are_not_hidden_by_the_driven_one(void **) {
    for (const double contact_stiffness : {1e5, 1e6}) {
        const Share s = share_at_the_struck_mass(contact_stiffness);
        assert_true(s.whole < 0.1 * s.truth); // what a share of the whole motion would tell
        // one step, and only the next H + 2 of the missing harmonics
        assert_true(s.estimate > 0.2 * s.truth && s.estimate < 3 * s.truth);
        assert_true(below(std::abs(s.at_dof / s.estimate - 1), 1e-12)); // the only contact DOF
    }
}

// --- few harmonics lead to many

struct Climbed {
    std::int64_t reached = 0;
    double difference = 1e300;
};
Climbed climbed() {
    const Reduced m = test::reduce_exactly(test::chain(3, 0.02, 20, 0.1, 0.4, 0.2, {0, 2}));
    HbmOptions few = test::by_harmonics(), many = few;
    few.n_harmonics = 5, many.n_harmonics = 40;
    const double omega = 0.85;
    plm::BranchPoint p = solver(m, few, 0.1, 1).solve(omega / (2 * M_PI), nullptr, 0)->points()[0];
    plm::climb_harmonics(m, many, 40, p, plm::Watch());
    const BranchPtr direct = solver(m, many, 0.1, 1).solve(omega / (2 * M_PI), nullptr, 0);
    Climbed c;
    c.reached = p.n_harmonics;
    if (p.n_harmonics != 40) return c;
    c.difference = 0;
    const plm::Matrix &eta = direct->points()[0].eta;
    const double size = plm::norm2(eta.rows() * eta.cols(), eta.data());
    for (std::int64_t k = 0; k < eta.rows() * eta.cols(); ++k)
        c.difference = std::hypot(c.difference, (eta.data()[k] - p.eta.data()[k]) / size);
    return c;
}
void many_harmonics_are_reached_from_few(void **) {
    const Climbed c = climbed();
    assert_int_equal(c.reached, 40);
    assert_true(below(c.difference, 1e-6)); // tolerance of Newton's method
}

// --- curves that say nothing

BranchPtr with_errors(const std::vector<double> &errors) {
    const Reduced m = driven_at(1);
    auto b = std::make_shared<plm::Branch>(m, 1.0);
    for (double error : errors) {
        plm::BranchPoint p;
        p.omega = 1 + 0.1 * static_cast<double>(b->points().size());
        p.eta_0.assign(1, 0.0);
        p.eta.reset(1, 2);
        p.n_harmonics = 1;
        p.harmonic_error = error;
        b->append(p);
    }
    return b;
}

// Few such points, as at the edges of regions where contact bounces, leave a curve its worth.
void a_curve_is_worthless_by_most_of_its_points(void **) {
    assert_false(plm::is_worthless(*with_errors({0, 0, 0})));
    assert_false(plm::is_worthless(*with_errors({3, 1e-3, 1e-3})));
    assert_false(plm::is_worthless(*with_errors({0.09, 0.09, 0.09})));
    assert_true(plm::is_worthless(*with_errors({0.2, 1e-3, 3})));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_load_that_the_harmonics_do_not_reach_is_refused),
        cmocka_unit_test(chosen_harmonics_begin_at_the_excitation),
        cmocka_unit_test(too_few_harmonics_are_said),
        cmocka_unit_test(errors_at_the_struck_part_are_not_hidden_by_the_driven_one),
        cmocka_unit_test(many_harmonics_are_reached_from_few),
        cmocka_unit_test(a_curve_is_worthless_by_most_of_its_points),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
