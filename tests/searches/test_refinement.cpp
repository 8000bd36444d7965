// One number, the tolerance: from poor bases of the cracked plate, also of a mode that is not the one that
// responds, to small ones whose true error is below it.
#include "capi/handles.hpp"
#include "reduction/basis.hpp"
#include "searches/hbm.hpp"
#include "searches/refinement.hpp"
#include "support/test.hpp"
extern "C" {
#include "cracked_plate.h"
#include "scene_model.h"
}
#include <cmath>

namespace {

struct Plate {
    plm_context *context = nullptr;
    plm_model *model = nullptr;
    scene *host = nullptr;
    explicit Plate(bool with_preload) {
        cracked_plate_params p;
        cracked_plate_quick(&p);
        p.with_preload = with_preload;
        if (cracked_plate_create(&p, &host) || plm_context_create(PLM_API_VERSION, &context)) return;
        must(context, scene_to_model(context, host, &model), "model");
    }
    ~Plate() {
        plm_context_destroy(&context);
        scene_destroy(&host);
    }
    // By the rule of the paper, which keeps few modes; mode: added to the number of the dominant one.
    std::shared_ptr<const plm::Basis> basis(const char *kind, int mode, int n_samples, double low,
                                            double high) {
        plm_sampler *sampler = nullptr;
        plm_basis *b = nullptr;
        must(context, plm_sampler_create(model, &sampler), "sampler");
        must(context, plm_sampler_set_string(sampler, "system", "open"), "system");
        must(context, plm_sampler_set_int(sampler, "mode", host->dominant_mode + mode), "mode");
        must(context, plm_sampler_set_int(sampler, "n_samples", n_samples), "n_samples");
        must(context, plm_sampler_set_int(sampler, "n_harmonics", 5), "n_harmonics"); // a small one
        must(context, plm_sampler_run(sampler), "sampler run");
        must(context, plm_basis_create(model, &b), "basis");
        must(context, plm_basis_set_string(b, "kind", kind), "kind");
        must(context, plm_basis_set_string(b, "selection", "bands"), "selection");
        must(context, plm_basis_set_double(b, "frequency_min_hz", low), "frequency_min_hz");
        must(context, plm_basis_set_double(b, "frequency_max_hz", high), "frequency_max_hz");
        must(context, plm_basis_set_sampler(b, sampler), "set_sampler");
        const plm_status s = plm_basis_build(b);
        if (s != plm::status::warning)
            must(context, s, "basis build"); // bands may lose the resonance: part of the case
        return plm::capi::find<plm::capi::BasisHandle>(b)->core;
    }
};

struct Reached {
    plm::Refinement refinement;
    double frequency = 1, amplitude = 1, first = 0; // true errors of the peak, and that of the start
    std::int64_t start_size = 0;
};

plm::Peak peak_of(const plm::Basis &basis, const plm::RefinementOptions &o) {
    const plm::Hbm hbm(basis.reduced(), 0, 0, o.hbm, plm::Watch());
    return hbm.find_peak(*hbm.sweep(), o.output.dof, o.output.measure, o.output.harmonic);
}

Reached refined(bool with_preload, int mode, int n_samples, double tolerance) {
    Plate plate(with_preload);
    const auto window = plate.basis("full", 0, 2, 0, 0);
    plm::RefinementOptions o;
    o.hbm.n_harmonics = 5;
    o.hbm.stability = plm::StabilityKind::off;
    o.hbm.frequency_min_hz = window->window_min_hz();
    o.hbm.frequency_max_hz = window->window_max_hz();
    o.output.dof = plate.host->output_dof;
    o.tolerance = tolerance;
    const auto start = plate.basis("plm", mode, n_samples, window->window_min_hz(), window->window_max_hz());
    const plm::Peak truth = peak_of(*window, o), first = peak_of(*start, o);
    Reached r;
    r.start_size = start->reduced()->size();
    r.first = std::abs(first.amplitude / truth.amplitude - 1);
    r.refinement = plm::refine(start, o, plm::Watch());
    const plm::Peak last = peak_of(*r.refinement.basis, o);
    r.frequency = std::abs(last.frequency_hz / truth.frequency_hz - 1);
    r.amplitude = std::abs(last.amplitude / truth.amplitude - 1);
    std::printf("    %d columns (error of the peak %.1e) to %d for %.0e: estimated %.1e, true %.1e in "
                "amplitude, %.1e in frequency, %d curves\n",
                static_cast<int>(r.start_size), r.first,
                static_cast<int>(r.refinement.basis->reduced()->size()), tolerance, r.refinement.error,
                r.amplitude, r.frequency, static_cast<int>(r.refinement.rounds));
    return r;
}

void tolerance_is_met_from_poor_bases(void **) {
    for (bool with_preload : {true, false})
        for (int mode : {0, 1}) { // 1: the next mode, a bad guess
            const Reached r = refined(with_preload, mode, 1 + mode, 1e-3);
            assert_true(r.refinement.met);
            assert_true(below(r.refinement.error, 1e-3));
            assert_true(below(r.amplitude, 1e-3) && below(r.frequency, 1e-3));
            assert_true(r.refinement.basis->reduced()->size() <= 18);
        }
}

void smaller_tolerance_larger_basis(void **) {
    const Reached coarse = refined(true, 0, 1, 1e-2), fine = refined(true, 0, 1, 1e-5);
    assert_true(coarse.first > 0.05); // the start was poor
    assert_true(coarse.refinement.met && fine.refinement.met);
    assert_true(below(coarse.amplitude, 1e-2) && below(fine.amplitude, 1e-5));
    assert_true(coarse.refinement.basis->reduced()->size() < fine.refinement.basis->reduced()->size());
}

void a_dof_that_rests_is_refused(void **) {
    Plate plate(false);
    const auto start = plate.basis("plm", 0, 2, 0, 0);
    plm::RefinementOptions o;
    o.hbm.n_harmonics = 3;
    o.hbm.frequency_min_hz = start->window_min_hz();
    o.hbm.frequency_max_hz = start->window_max_hz();
    for (std::int64_t dof = 0; dof < start->model()->n_dof(); ++dof)
        if (start->model()->terms(dof).empty()) o.output.dof = dof; // fixed
    bool refused = false;
    try {
        plm::refine(start, o, plm::Watch());
    } catch (const plm::Error &e) {
        refused = e.status() == plm::status::argument;
    }
    assert_true(refused);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(tolerance_is_met_from_poor_bases),
        cmocka_unit_test(smaller_tolerance_larger_basis),
        cmocka_unit_test(a_dof_that_rests_is_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
