#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "capi/branch_end.hpp"
#include "capi/handles.hpp"
#include "capi/hbm_input.hpp"
#include "capi/outcome.hpp"
#include "searches/computed_response.hpp"
#include <cmath>

using namespace plm::capi;

namespace {

/// The handles behind what was computed, as if the host had made one after the other.
std::shared_ptr<HbmHandle> handles_of(const plm::ComputedResponse &r, const plm::Warnings &warnings,
                                      std::shared_ptr<ModelHandle> model) {
    const std::shared_ptr<Context> owner = model->owner;
    const auto basis = std::make_shared<BasisHandle>(owner, model);
    basis->basis_options = r.basis->options();
    basis->core = r.basis;
    basis->work = r.setup;
    if (r.basis->sampler()) {
        basis->sampler = std::make_shared<SamplerHandle>(owner, std::move(model));
        basis->sampler->sampler_options = r.basis->sampler()->options();
        basis->sampler->core = r.basis->sampler();
    }
    const auto hbm = std::make_shared<HbmHandle>(owner, basis);
    hbm->hbm_options = r.options;
    hbm->warnings = warnings;
    hbm->larger = r.larger;
    if (r.larger) hbm->found.push_back({r.larger->curve, r.larger->force_low, r.larger->force_high});
    return hbm;
}

/// What plm_branch_describe() says of the curve beside its points.
std::shared_ptr<plm::CurveFindings> findings_of(const plm::ComputedResponse &r, const plm::Output &output,
                                                double accuracy, const plm::Warnings &warnings) {
    auto found = std::make_shared<plm::CurveFindings>(findings_at(r.peak, output, *r.basis, warnings));
    found->error = r.error;
    found->accuracy = accuracy;
    found->looked_beside = r.looked_beside;
    found->larger = r.larger;
    return found;
}

/// How the curve ended, where that is not as it should be, else what there is to look at.
Outcome outcome_of(const plm::ComputedResponse &r, const plm::Warnings &warnings) {
    Outcome outcome(warnings);
    const plm_status ended = end_status(r.curve->end_reason);
    if (ended == PLM_OK) return outcome;
    const plm::BranchPoint &last = r.curve->points().back();
    return {
        ended, r.curve->end_reason,
        plm::format("the curve ended early, at %.6g Hz after %zu points (%s): frequency_hz and amplitude are "
                    "those of the highest point so far, and a higher one may follow. Sweep with "
                    "the hbm of this call and other options of it",
                    last.omega / (2 * M_PI), r.curve->points().size(),
                    plm::end_text(r.curve->end_reason).c_str()) +
            (outcome.text.empty() ? "" : "; beside that: " + outcome.text)};
}

} // namespace

plm_status plm_model_compute_response(plm_model *model, std::int64_t dof, std::int32_t measure,
                                      double accuracy, double *frequency_hz, double *amplitude, double *error,
                                      plm_branch **curve, plm_hbm **hbm) {
    return call<ModelHandle>("plm_model_compute_response", model, [&](ModelHandle &m) {
        const std::shared_ptr<const plm::Model> &core = built(m);
        require_range(dof, 0, core->n_outputs() - 1, "dof");
        require_range(measure, PLM_PEAK, PLM_RMS, "measure");
        require_finite(accuracy, "accuracy");
        if (!(accuracy >= 1e-8 && accuracy <= 0.5))
            bad_argument(
                "accuracy", -1,
                plm::format("accuracy is %g; a relative error of 1e-8 to 0.5 is wanted, such as 1e-3",
                            accuracy));
        require_pointer(frequency_hz, "frequency_hz");
        require_pointer(amplitude, "amplitude");
        if (core->n_pairs() == 0)
            throw plm::Error(PLM_ERR_STATE, "the model has no contact pair: its response is linear, and a "
                                            "basis of kind full or craig_bampton gives it")
                .argument("model");
        const plm::Output output = {dof, static_cast<plm::Measure>(measure), 0};
        const plm::ComputedResponse r = within_effort(INFINITY, [&] {
            return plm::compute_response(core, m.space, output, accuracy, m.owner->effort_beside(0),
                                         m.owner->watch());
        });
        m.space = r.basis->sampler() ? r.basis->sampler()->space() : m.space; // the next one starts from it
        const double highest[] = {r.peak.frequency_hz, r.peak.amplitude};
        plm::require_finite_result(highest, 2, "frequency_hz, amplitude");
        plm::Warnings warnings = m.warnings; // of a model that is not meant so no answer is
        warnings.add(r.warnings);
        const Outcome outcome = outcome_of(r, warnings);
        plm_hbm *solver = hbm ? publish(handles_of(r, warnings, find<ModelHandle>(model))) : nullptr;
        const auto handle = std::make_shared<BranchHandle>(m.owner, r.curve);
        handle->found = findings_of(r, output, accuracy, warnings);
        plm_branch *branch = curve ? publish(handle) : nullptr;
        if (hbm) *hbm = solver;
        if (curve) *curve = branch;
        *frequency_hz = r.peak.frequency_hz, *amplitude = r.peak.amplitude;
        if (error) *error = r.error;
        return outcome;
    });
}
