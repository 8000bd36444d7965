// Curves in the plane of frequency and amplitude: between the points of a sweep they are as exact as at them.
#include "capi/handles.hpp"
#include "searches/hbm.hpp"
#include "study/plane_curve.hpp"
#include "support/test.hpp"
extern "C" {
#include "oscillator.h"
}

namespace {

constexpr double zeta = 0.02;

plm::HbmOptions options_for(double max_step) {
    plm::HbmOptions o;
    o.n_harmonics = 5;
    o.frequency_min_hz = 0.12, o.frequency_max_hz = 0.2; // around 1 rad/s
    o.stability = plm::StabilityKind::off;
    o.max_step = max_step;
    return o;
}

/// m = k = 1 with a stop at `gap`.
struct Structure {
    plm_context *context = nullptr;
    plm_basis *basis = nullptr;
    explicit Structure(double gap) {
        const oscillator o = {1, 2 * zeta, 0.3, gap, 1};
        plm_model *model = nullptr;
        if (plm_context_create(PLM_API_VERSION, &context)) return;
        if (oscillator_built(context, &o, 1, &model, &basis)) basis = nullptr;
    }
    ~Structure() { plm_context_destroy(&context); }
};

struct Traced {
    plm::PlaneCurve curve;
    std::size_t points = 0;
};

Traced trace(const Structure &s, const plm::HbmOptions &o, double tolerance) {
    const auto reduced = plm::capi::find<plm::capi::BasisHandle>(s.basis)->core->reduced();
    const auto branch = plm::Hbm(reduced, 0, 0, o, plm::Watch()).sweep();
    return {plm::plane_curve(*branch, o, plm::Output(), {0.08, 25}, tolerance), branch->points().size()};
}

// Contact out of reach: amplitude 1 / |1 - w^2 + 2 i zeta w|.
double linear_amplitude(double w) {
    return 1 / std::hypot(1 - w * w, 2 * zeta * w) / 25;
}

void between_coarse_points_a_linear_response_is_the_closed_form(void **) {
    double worst = 0;
    Traced t;
    {
        const Structure s(1e6);
        t = trace(s, options_for(0.3), 1e-7);
        for (const plm::PlanePoint &p : plm::equally_spaced(t.curve.pieces, 2000)) {
            const double per = 2 * M_PI * 0.08, w = per * p.x, step = 1e-6;
            const double slope = per * (linear_amplitude(w + step) - linear_amplitude(w - step)) / (2 * step);
            worst = std::max(worst, std::abs(p.y - linear_amplitude(w)) /
                                        std::hypot(1.0, slope)); // across the curve
        }
    }
    print_message("%zu points of the sweep, %zu pieces, resolution %.1e, true %.1e\n", t.points,
                  t.curve.pieces.size(), t.curve.resolution, worst);
    assert_true(t.curve.unresolved == 0 && t.curve.resolution <= 1e-7);
    // what the resolution says; chords between these points are 1e-3 off
    assert_true(below(worst, 1.1e-7));
}

// With contact: the curvature jumps where the pair begins to move.
void the_steps_of_the_sweep_do_not_matter(void **) {
    Traced a, b;
    double apart = 1;
    {
        const Structure s(5);
        a = trace(s, options_for(0.3), 5e-7), b = trace(s, options_for(0.03), 5e-8);
        apart = plm::curve_distance(plm::equally_spaced(a.curve.pieces, 3000), b.curve.pieces).max;
    }
    print_message("%zu and %zu points; resolution %.1e and %.1e; apart %.1e\n", a.points, b.points,
                  a.curve.resolution, b.curve.resolution, apart);
    assert_true(2 * b.points > 3 * a.points);
    assert_true(below(apart, 2 * 5.5e-7)); // both resolutions; they are estimates
}

// Exact motions have no harmonics by which points between them could be found: they follow from the flow,
// too.
void between_exact_motions_points_are_exact_motions(void **) {
    Traced a, b;
    double apart = 1;
    {
        const Structure s(5);
        plm::HbmOptions coarse = options_for(0.3), fine = options_for(0.03);
        for (plm::HbmOptions *o : {&coarse, &fine}) o->n_harmonics = 0, o->motion = plm::MotionKind::exact;
        a = trace(s, coarse, 5e-7), b = trace(s, fine, 5e-8);
        apart = plm::curve_distance(plm::equally_spaced(a.curve.pieces, 3000), b.curve.pieces).max;
    }
    print_message("%zu and %zu points; resolution %.1e and %.1e; apart %.1e\n", a.points, b.points,
                  a.curve.resolution, b.curve.resolution, apart);
    assert_true(a.points < b.points && a.curve.unresolved == 0 && a.curve.resolution <= 5e-7);
    assert_true(below(apart, 2 * 5.5e-7));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(between_coarse_points_a_linear_response_is_the_closed_form),
        cmocka_unit_test(the_steps_of_the_sweep_do_not_matter),
        cmocka_unit_test(between_exact_motions_points_are_exact_motions),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
