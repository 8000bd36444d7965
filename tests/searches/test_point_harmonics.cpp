// A point keeps the number of harmonics it was solved with, whatever the options say when it is used again.
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "hbm/system.hpp"
#include "motions/penetration.hpp"
#include "reduction/basis.hpp"
#include "sampling/small_models.hpp"
#include "searches/curve.hpp"
#include "searches/hbm.hpp"
#include "searches/isolated.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <cmath>

using Model = std::shared_ptr<const plm::ReducedModel>;

namespace {

// A mass that strikes a stop at its resonance: harmonics do not end at five.
Model striking() {
    return test::reduce_exactly(test::bilinear_oscillator(0.05, 3, 0.2, 0.2, 0));
}
plm::HbmOptions options(std::int64_t harmonics) {
    plm::HbmOptions o;
    o.motion = plm::MotionKind::harmonics;
    o.n_harmonics = harmonics;
    o.frequency_min_hz = 0.6 / (2 * M_PI);
    o.frequency_max_hz = 1.8 / (2 * M_PI);
    return o;
}
plm::BranchPoint solved(const Model &m, const plm::HbmOptions &o) {
    return plm::Hbm(m, 0, 0, o, plm::Watch()).solve(1.1 / (2 * M_PI), nullptr, 0)->points()[0];
}

// The number of the options was taken for that of the point: read beyond the contact forces of five
// harmonics.
void the_error_of_a_point_does_not_depend_on_the_options(void **) {
    for (auto unknowns : {plm::NonlinearUnknowns::modal, plm::NonlinearUnknowns::gaps}) {
        const Model m = striking();
        plm::HbmOptions own = options(5), other = options(9), fewer = options(2);
        own.unknowns = other.unknowns = fewer.unknowns = unknowns;
        const plm::BranchPoint point = solved(m, own);
        plm::BranchPoint measured[3] = {point, point, point};
        plm::measure_harmonics(m, own, measured[0]);
        plm::measure_harmonics(m, other, measured[1]);
        plm::measure_harmonics(m, fewer, measured[2]);
        std::printf("    harmonic_error %.3e, with other options %.3e and %.3e\n", measured[0].harmonic_error,
                    measured[1].harmonic_error, measured[2].harmonic_error);
        assert_true(measured[0].harmonic_error > 0);
        assert_true(measured[1].harmonic_error == measured[0].harmonic_error);
        assert_true(measured[2].harmonic_error == measured[0].harmonic_error);
    }
}

// A fixed curve, and harmonics as needed for its peak: what is returned solves the equations in the number
// that it says.
struct FoundPeak {
    std::int64_t harmonics = 0, of_curve = 0;
    double residual = 1e300, error = -1, error_again = -2;
};
FoundPeak peak_of_a_coarse_curve() {
    plm::BasisOptions basis;
    basis.kind = &plm::basis_kinds::full;
    basis.frequency_min_hz = options(0).frequency_min_hz,
    basis.frequency_max_hz = options(0).frequency_max_hz;
    test::ModelExtras damped;
    damped.explicit_damping = true;
    const auto model = test::make_model(test::bilinear_oscillator(0.05, 3, 0.2, 0.2, 0), damped);
    const Model m = plm::Basis(model, nullptr, nullptr, basis, plm::Watch()).reduced();
    plm::HbmOptions coarse = options(0), automatic = options(0);
    coarse.max_harmonics = 5;
    const auto curve = plm::Hbm(m, 0, 0, coarse, plm::Watch()).sweep();
    const plm::Peak peak =
        plm::Hbm(m, 0, 0, automatic, plm::Watch()).find_peak(*curve, 0, plm::Measure::peak, 0);
    plm::BranchPoint again = peak.branch->points()[0];
    const auto system = plm::make_system(m, options(again.n_harmonics));
    plm::vector<double> x(static_cast<std::size_t>(system->size())), r(x);
    system->from_point(again, x.data());
    system->residual(x.data(), again.omega, r.data());
    FoundPeak found{again.n_harmonics, curve->n_harmonics(), plm::norm2(system->size(), r.data()),
                    again.harmonic_error, 0};
    plm::measure_harmonics(m, automatic, again);
    found.error_again = again.harmonic_error;
    return found;
}
void a_peak_is_a_solution_in_its_own_harmonics(void **) {
    const FoundPeak p = peak_of_a_coarse_curve();
    std::printf("    H of the curve %d, of the peak %d; residual %.1e of the force, harmonic_error %.2e, "
                "again %.2e\n",
                static_cast<int>(p.of_curve), static_cast<int>(p.harmonics), p.residual, p.error,
                p.error_again);
    assert_int_equal(p.of_curve, 5);
    assert_true(p.harmonics > 5);
    assert_true(p.residual < 1e-6); // the force is 0.2; the peak's Newton method stops at 1e-12 of the motion
    assert_true(std::isfinite(p.error) && p.error_again == p.error);
}

// Phase resonance is that of the driven harmonic, here the third, which one harmonic does not hold.
void the_driven_harmonic_must_be_among_those_solved(void **) {
    auto m = std::make_shared<plm::ReducedModel>(*striking());
    const plm::HarmonicLoad load = m->excitation.at(1);
    m->excitation.clear();
    m->excitation[3] = load;
    plm::HbmOptions enough = options(5), few = options(1);
    enough.frequency_min_hz /= 3, enough.frequency_max_hz /= 3;
    few.frequency_min_hz = enough.frequency_min_hz, few.frequency_max_hz = enough.frequency_max_hz;
    const auto curve = plm::Hbm(m, 0, 0, enough, plm::Watch()).sweep();
    std::string argument;
    std::int32_t status = plm::status::ok;
    try {
        plm::Hbm(m, 0, 0, few, plm::Watch()).find_isolated(*curve, 2.0);
    } catch (const plm::Error &e) {
        argument = e.argument(), status = e.status();
    }
    assert_int_equal(status, plm::status::argument);
    assert_string_equal(argument.c_str(), "n_harmonics");
}

// The motion that the contact law sees is a part of the point like its coordinates.
void a_longer_period_keeps_the_contact_motion(void **) {
    const Model m = striking();
    plm::HbmOptions o = options(5);
    o.unknowns = plm::NonlinearUnknowns::gaps;
    o.formulation = plm::FormulationKind::compliance;
    const Model stiff = test::reduce_exactly(test::bilinear_oscillator(0.02, 1e4, 0.5, 1, 0));
    const plm::BranchPoint point =
        plm::Hbm(stiff, 0, 0, o, plm::Watch()).solve(1.1 / (2 * M_PI), nullptr, 0)->points()[0];
    assert_true(point.contact_stiffness != nullptr);
    const plm::BranchPoint longer = plm::on_longer_period(point, 3);
    assert_int_equal(longer.n_harmonics, 15);
    assert_int_equal(longer.contact_motion.cols(), 31);
    for (std::int64_t c = 0; c < 31; ++c) {
        const std::int64_t h = (c + 1) / 2;
        const double want = h % 3 == 0 ? point.contact_motion(0, c == 0       ? 0
                                                                 : c % 2 == 1 ? 2 * h / 3 - 1
                                                                              : 2 * h / 3)
                                       : 0;
        assert_true(longer.contact_motion(0, c) == want);
    }
}

// Motions that are none are refused by the branch; indicators that are none become unknown, and are warned
// of.
std::int32_t reason_of(const plm::BranchPoint &point, plm::Branch &branch) {
    try {
        branch.append(point);
    } catch (const plm::Error &e) {
        return e.reason();
    }
    return plm::reason::none;
}
void a_branch_holds_numbers_only(void **) {
    const Model m = striking();
    plm::Branch branch(m, 1);
    plm::BranchPoint good = solved(m, options(3)), bad = good, blurred = good;
    bad.eta(0, 1) = INFINITY;
    blurred.harmonic_error = NAN;
    blurred.multipliers = {{NAN, 0}, {0.5, 0}};
    assert_int_equal(reason_of(good, branch), plm::reason::none);
    assert_true(branch.warnings.empty());
    assert_int_equal(reason_of(bad, branch), plm::reason::not_finite);
    assert_int_equal(branch.points().size(), 1);
    assert_int_equal(reason_of(blurred, branch), plm::reason::none);
    assert_true(branch.warnings.has(plm::reason::not_finite));
    assert_true(branch.points()[1].harmonic_error == -1);
    assert_int_equal(plm::stability_of(branch.points()[1]), -1);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_error_of_a_point_does_not_depend_on_the_options),
        cmocka_unit_test(a_peak_is_a_solution_in_its_own_harmonics),
        cmocka_unit_test(the_driven_harmonic_must_be_among_those_solved),
        cmocka_unit_test(a_longer_period_keeps_the_contact_motion),
        cmocka_unit_test(a_branch_holds_numbers_only),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
