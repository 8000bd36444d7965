// The error of a point without the unreduced solution: the corrected point lies on the unreduced curve, which
// is solved here to see. Penalty and compliance form, sub-harmonic branches, single solutions.
#include "hbm/formulation.hpp"
#include "reduction/basis.hpp"
#include "searches/chains.hpp"
#include "searches/error_estimate.hpp"
#include "searches/hbm.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <vector>

using plm::BasisOptions;
using plm::ErrorEstimate;
using plm::ErrorEstimator;
using plm::HbmOptions;
using plm::Measure;
using test::Chains;
using test::chains;
using test::watched;

namespace {

using BranchPtr = std::shared_ptr<const plm::Branch>;

constexpr Measure measure = Measure::half_peak_to_peak;

plm::Hbm solver(std::shared_ptr<const plm::ReducedModel> m, const HbmOptions &o, double low_hz,
                double high_hz) {
    return plm::Hbm(std::move(m), low_hz, high_hz, o, plm::Watch());
}
double amplitude(const plm::Branch &b, std::int64_t dof = watched) {
    return b.amplitude(0, dof, measure, 0);
}

HbmOptions nine_harmonics() {
    HbmOptions o;
    o.n_harmonics = 9;
    o.stability = plm::StabilityKind::off;
    return o;
}

// Single solutions at five frequencies: how far the corrected point is from the unreduced curve at its
// frequency, against how far it was moved.
struct Corrected {
    double moved = 0, left = 0, largest_true = 0; // of the amplitude
    bool compliant = false, same_law = true;
};
Corrected corrected_points(const Chains &c) {
    const HbmOptions o = nine_harmonics();
    const plm::Hbm reduced = solver(c.reduced->reduced(), o, c.low_hz, c.high_hz),
                   full = solver(c.full->reduced(), o, c.low_hz, c.high_hz);
    Corrected r;
    const plm::LawForm wanted = plm::make_formulation(*c.full->reduced(), o),
                       given = plm::make_formulation(*c.reduced->reduced(), o);
    r.compliant = wanted.compliant && given.compliant;
    r.same_law = wanted.stiffness == given.stiffness;
    for (int k = 1; k < 6; ++k) {
        const double hz = c.low_hz + (c.high_hz - c.low_hz) * k / 6;
        const BranchPtr point = reduced.solve(hz, nullptr, 0);
        const ErrorEstimate e = ErrorEstimator(c.full->reduced(), *point, o).estimate(0, watched, measure, 0);
        const double a = amplitude(*point), by = e.amplitude.basis + e.amplitude.contact,
                     shift = e.frequency_hz.basis + e.frequency_hz.contact,
                     there = amplitude(*full.solve(hz + shift, nullptr, 0)),
                     same_hz = amplitude(*full.solve(hz, nullptr, 0));
        r.moved = std::max({r.moved, std::abs(by) / a, std::abs(shift) / hz});
        r.left = std::max(r.left, std::abs(there - a - by) / a);
        r.largest_true = std::max(r.largest_true, std::abs(same_hz / a - 1));
    }
    std::printf("    true %.1e, moved by %.1e, then off the curve by %.1e%s\n", r.largest_true, r.moved,
                r.left, r.compliant ? " (compliance)" : "");
    return r;
}

void corrected_points_lie_on_the_unreduced_curve(void **) {
    for (const bool with_preload : {false, true})
        for (const double contact_stiffness : {2.0, 20.0}) {
            const Corrected c = corrected_points(chains(contact_stiffness, with_preload, 3));
            assert_true(!c.compliant && c.largest_true > 1e-6 && c.largest_true < 1e-3);
            assert_true(below(c.left, 1e-3 * c.largest_true));
            assert_true(c.moved > 0.2 * c.largest_true && c.moved < 5 * c.largest_true);
        }
}

void in_compliance_form_up_to_the_rigid_limit(void **) {
    bool laws_differ = false;
    int in_error = 0;
    for (const bool with_preload : {false, true})
        for (const double contact_stiffness : {3e4, 1e9}) {
            const Corrected c = corrected_points(chains(contact_stiffness, with_preload, 8));
            assert_true(c.compliant);
            constexpr double rounding = 1e-12;
            assert_true(below(c.left, 1e-2 * c.largest_true + rounding));
            in_error += c.largest_true > 1e-8;
            laws_differ =
                laws_differ || !c.same_law; // the unknowns of the two structures mean different things
        }
    assert_true(laws_differ && in_error >= 2);
}

// Stiff contact on a coarse basis: contact sets differ, and one tangent does not hold as far as its step
// goes. What is told is then either the way to the unreduced curve, or nothing.
struct Stiff {
    int told = 0, refused = 0;
    double left = 0; // of what is told, the worst distance from the unreduced curve over how far it went
};
Stiff stiff_points(double contact_stiffness, std::int64_t basis_harmonics) {
    const Chains c = chains(contact_stiffness, false, basis_harmonics);
    HbmOptions o = nine_harmonics();
    o.formulation = plm::FormulationKind::penalty;
    const plm::Hbm reduced = solver(c.reduced->reduced(), o, c.low_hz, c.high_hz),
                   full = solver(c.full->reduced(), o, c.low_hz, c.high_hz);
    Stiff s;
    for (int k = 1; k < 8; ++k) {
        const double hz = c.low_hz + (c.high_hz - c.low_hz) * k / 8;
        const BranchPtr point = reduced.solve(hz, nullptr, 0);
        const ErrorEstimate e =
            ErrorEstimator(c.full->reduced(), *point, o).estimate(0, watched, measure, 0, false);
        if (!e.known) {
            ++s.refused;
            s.left = std::isnan(e.amplitude.sum() + e.frequency_hz.sum()) ? s.left : 1e300;
            continue;
        }
        const double a = amplitude(*point), by = e.amplitude.sum(),
                     there = amplitude(*full.solve(hz + e.frequency_hz.sum(), nullptr, 0)),
                     moved = std::hypot(by / a, e.frequency_hz.sum() / hz);
        ++s.told;
        std::printf("      at %.4g Hz told %.1e (%.1e in frequency), off the curve by %.1e\n", hz, by / a,
                    e.frequency_hz.sum() / hz, std::abs(there - a - by) / a);
        s.left = std::max(s.left, std::abs(there - a - by) / a / std::max(moved, 1e-8));
    }
    std::printf("    stiffness %.0e: %d told, %d refused, left %.1e\n", contact_stiffness, s.told, s.refused,
                s.left);
    return s;
}
void where_contact_is_stiff_the_estimate_is_right_or_none(void **) {
    int told = 0, refused = 0;
    double left = 0;
    for (const std::int64_t basis_harmonics : {1, 3})
        for (const double contact_stiffness : {200.0, 2e3}) {
            const Stiff s = stiff_points(contact_stiffness, basis_harmonics);
            told += s.told, refused += s.refused;
            left = std::max(left, s.left);
        }
    assert_true(told > 0 && refused > 0);
    assert_true(below(left, 0.3)); // the last step is a small part of the first one
}

// Of the unreduced structure itself only harmonics are missing.
struct OfTheWhole {
    double basis = 1, harmonics = 0, missing = 0;
};
OfTheWhole of_the_whole() {
    const Chains c = chains(20, true, 3);
    HbmOptions o = nine_harmonics(), many = o;
    o.n_harmonics = 4, many.n_harmonics = 40;
    const double hz = 0.5 * (c.low_hz + c.high_hz);
    const BranchPtr point = solver(c.full->reduced(), o, c.low_hz, c.high_hz).solve(hz, nullptr, 0);
    const ErrorEstimate e = ErrorEstimator(c.full->reduced(), *point, o).estimate(0, watched, measure, 0);
    OfTheWhole w;
    w.basis = std::max({std::abs(e.amplitude.basis), std::abs(e.amplitude.contact),
                        std::abs(e.frequency_hz.basis), std::abs(e.frequency_hz.contact)}) /
              amplitude(*point);
    const BranchPtr there =
        solver(c.full->reduced(), many, c.low_hz, c.high_hz).solve(hz + e.frequency_hz.sum(), nullptr, 0);
    w.harmonics = e.amplitude.harmonics / amplitude(*point);
    w.missing = amplitude(*there) / amplitude(*point) - 1;
    return w;
}
void of_the_unreduced_structure_only_harmonics_are_missing(void **) {
    const OfTheWhole w = of_the_whole();
    std::printf("    basis %.1e; harmonics: estimated %.2e, true %.2e\n", w.basis, w.harmonics, w.missing);
    assert_true(below(w.basis, 1e-7));
    assert_true(w.harmonics / w.missing > 0.25 && w.harmonics / w.missing < 4);
}

// The structure's own C, not reduced.
std::shared_ptr<const plm::ReducedModel> whole(const exact::Structure &s, double low_hz, double high_hz) {
    BasisOptions o;
    o.kind = &plm::basis_kinds::full;
    o.frequency_min_hz = low_hz;
    o.frequency_max_hz = high_hz;
    return plm::Basis(test::make_model(s, {{}, 0, 0, true}), nullptr, nullptr, o, plm::Watch()).reduced();
}

// A doubled response of an oscillator that touches: the period counts twice, and harmonics are those of half
// the frequency.
struct Doubled {
    std::int64_t multiple = 0;
    double basis = 1, estimated = 0, missing = 0;
};
Doubled doubled_response() {
    const double low = 2.0 / (2 * M_PI), high = 3.8 / (2 * M_PI);
    const auto m = whole(test::bilinear_oscillator(0.02, 3, 0, 1, 0), low, high);
    HbmOptions o;
    o.n_harmonics = 6;
    const plm::Hbm hbm = solver(m, o, low, high);
    const BranchPtr branch = hbm.sweep();
    Doubled d;
    std::int64_t at = -1;
    for (std::size_t i = 0; i < branch->points().size(); ++i)
        if (branch->points()[i].bifurcation == plm::bifurcation::period_doubling)
            at = static_cast<std::int64_t>(i);
    if (at < 0) return d;
    const BranchPtr doubled = hbm.switch_branch(*branch, at, false);
    d.multiple = doubled->period_multiple();
    const std::int64_t point = static_cast<std::int64_t>(doubled->points().size()) / 4;
    const ErrorEstimate e = ErrorEstimator(m, *doubled, o).estimate(point, 0, measure, 0);
    const double a = doubled->amplitude(point, 0, measure, 0),
                 hz = doubled->points()[point].omega / (2 * M_PI);
    d.basis = std::max({std::abs(e.amplitude.basis), std::abs(e.amplitude.contact),
                        std::abs(e.frequency_hz.basis), std::abs(e.frequency_hz.contact)}) /
              a;
    HbmOptions many = o;
    many.n_harmonics = 40;
    many.period_multiple = 2;
    const BranchPtr there = solver(m, many, low, high).solve(hz + e.frequency_hz.sum(), doubled.get(), point);
    d.estimated = e.amplitude.harmonics / a;
    d.missing = there->amplitude(0, 0, measure, 0) / a - 1;
    return d;
}
void on_a_branch_of_twice_the_period(void **) {
    const Doubled d = doubled_response();
    std::printf("    basis %.1e; harmonics: estimated %.2e, true %.2e\n", d.basis, d.estimated, d.missing);
    assert_int_equal(d.multiple, 2);
    assert_true(below(d.basis, 1e-7));
    assert_true(d.estimated / d.missing > 0.25 && d.estimated / d.missing < 4);
}

// What has no error to estimate.
void motions_without_excitation_are_refused(void **) {
    const auto refusal = test::failure_of([] {
        const auto m = whole(test::bilinear_oscillator(0.02, 3, 0, 1, 0.5), 0.1, 0.5);
        HbmOptions o;
        o.n_harmonics = 5;
        const BranchPtr mode = solver(m, o, 0.1, 0.5).find_nonlinear_mode(1, 0, 1.0);
        ErrorEstimator(m, *mode, o).estimate(1, 0, measure, 0);
    });
    assert_int_equal(refusal.status, plm::status::argument);
    assert_string_equal(refusal.argument.c_str(), "point");
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(corrected_points_lie_on_the_unreduced_curve),
        cmocka_unit_test(in_compliance_form_up_to_the_rigid_limit),
        cmocka_unit_test(where_contact_is_stiff_the_estimate_is_right_or_none),
        cmocka_unit_test(of_the_unreduced_structure_only_harmonics_are_missing),
        cmocka_unit_test(on_a_branch_of_twice_the_period),
        cmocka_unit_test(motions_without_excitation_are_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
