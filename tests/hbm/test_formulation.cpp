// The compliance formulation: the same answers as the penalty in the limit of many harmonics, and the rigid
// limit, where the penalty stops at the first touch.
#include "contact/trig_polynomial.hpp"
#include "hbm/formulation.hpp"
#include "support/small_solver.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <vector>

using plm::FormulationKind;
using plm::HbmOptions;
using test::peak_at;
using test::solver;

namespace {

using Model = std::shared_ptr<const plm::ReducedModel>;

// A mass against a stop: relative error of the peak against the exact orbit.
double error_at(FormulationKind kind, int harmonics) {
    const exact::Structure s = test::bilinear_oscillator(0.05, 500, 0.2, 1, 0);
    const Model m = test::reduce_exactly(s);
    HbmOptions o;
    o.n_harmonics = harmonics;
    o.unknowns = plm::NonlinearUnknowns::gaps;
    o.formulation = kind;
    const double omega = 2.0; // linear amplitude 0.33 against a gap of 0.2
    const auto branch = solver(m, o, 1, 4).solve(omega / (2 * M_PI), nullptr, 0);
    const plm::BranchPoint &p = branch->points()[0];
    const auto q = test::displacement(*m, p.eta_0, p.eta, 0);
    const plm::TrigValue v = plm::evaluate_trig(q.data(), p.eta.cols() / 2, 0.0);
    const exact::Orbit orbit = exact::periodic_orbit(s, omega, {v.value, omega * v.slope}, 0, 2000);
    return orbit.converged ? std::abs(peak_at(*m, p, 0) / orbit.peak(0) - 1) : 1e300;
}
void both_forms_converge_to_the_exact_orbit(void **) {
    double last = 1e300;
    for (int h : {5, 20, 80}) {
        const double penalty = error_at(FormulationKind::penalty, h),
                     compliance = error_at(FormulationKind::compliance, h);
        std::printf("    H %d: penalty %.1e, compliance %.1e\n", h, penalty, compliance);
        assert_true(below(compliance, 0.5 * last));
        last = compliance;
        if (h == 80) assert_true(below(penalty, 1e-4) && below(compliance, 1e-3));
    }
}

// A chain against a stop, swept through its resonance and the grazing corner, ever stiffer.
struct Swept {
    std::int32_t reason = 0;
    double top = 0, worst_opening = 0;
    bool compliant = false;
};
Swept sweep(double stiffness, FormulationKind kind) {
    const exact::Structure s = test::chain(4, 0.02, stiffness, 0.5, 0.05, 0, {3});
    const Model m = test::reduce_exactly(s);
    HbmOptions o;
    o.n_harmonics = 20;
    o.formulation = kind;
    o.stability = plm::StabilityKind::off;
    const auto branch = solver(m, o, 0.2, 0.6).sweep();
    Swept w;
    w.reason = branch->end_reason;
    w.compliant = plm::make_formulation(*m, o).compliant;
    for (const auto &p : branch->points()) w.top = std::max(w.top, peak_at(*m, p, 3));
    return w;
}
void the_rigid_limit_is_reached_by_default(void **) {
    const Swept stiff = sweep(1e5, FormulationKind::automatic),
                rigid = sweep(1e12, FormulationKind::automatic), soft = sweep(30, FormulationKind::automatic);
    std::printf("    peak at k_n = 30: %.6f, 1e5: %.6f, 1e12: %.6f\n", soft.top, stiff.top, rigid.top);
    assert_true(!soft.compliant && stiff.compliant && rigid.compliant);
    assert_int_equal(stiff.reason, plm::reason::range_end);
    assert_int_equal(rigid.reason, plm::reason::range_end);
    assert_true(close_to(rigid.top, stiff.top, 5e-3)); // points of two sweeps, and O(1/k_n)
}

void the_form_can_be_refused(void **) {
    HbmOptions o;
    o.unknowns = plm::NonlinearUnknowns::modal;
    o.formulation = FormulationKind::compliance;
    bool refused = false;
    try {
        solver(test::reduce_exactly(test::bilinear_oscillator(0.05, 3, 0, 1, 0)), o, 1, 2);
    } catch (const plm::Error &e) {
        refused = e.status() == plm::status::argument;
    }
    assert_true(refused);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(both_forms_converge_to_the_exact_orbit),
        cmocka_unit_test(the_rigid_limit_is_reached_by_default),
        cmocka_unit_test(the_form_can_be_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
