#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "capi/branch_end.hpp"
#include "capi/branch_input.hpp"
#include "capi/hbm_input.hpp"
#include "linalg/scale.hpp"
#include "reduction/widened_model.hpp"
#include "searches/error_estimate.hpp"
#include "searches/refinement.hpp"
#include <algorithm>
#include <cmath>

namespace plm::capi {

Hbm solver(const HbmHandle &h) {
    return Hbm(built(*h.basis), h.hbm_options, h.owner->watch());
}

plm_branch *publish_branch(const HbmHandle &h, BranchPtr core) {
    return publish(std::make_shared<BranchHandle>(h.owner, std::move(core)));
}

Outcome deliver(HbmHandle &h, Warnings warnings) {
    h.warnings = std::move(warnings);
    return h.warnings;
}

Outcome deliver(HbmHandle &h, BranchPtr core, plm_branch **branch) {
    const std::int32_t reason = core->end_reason;
    Outcome outcome = deliver(h, core->warnings);
    if (const plm_status ended = end_status(reason); ended != PLM_OK)
        outcome = {ended, reason,
                   end_text(reason) + (outcome.text.empty() ? "" : "; beside that: " + outcome.text)};
    *branch = publish_branch(h, std::move(core));
    return outcome;
}

std::shared_ptr<BranchHandle> own_branch(const HbmHandle &h, const plm_branch *branch, const char *name) {
    std::shared_ptr<BranchHandle> b = same_context<BranchHandle>(h, branch, name);
    if (!of_one_basis(b->core->reduced_model(), built(*h.basis)->reduced()))
        bad_argument(
            name, -1,
            format("the branch %s was computed on another basis, or before the basis was built anew; "
                   "compute it with this one",
                   name));
    return b;
}

namespace {

bool is_same(const Output &a, const Output &b) {
    return a.dof == b.dof && a.measure == b.measure &&
           (a.measure != Measure::harmonic || a.harmonic == b.harmonic);
}

/// What is known of a curve with this peak of it: kept where the amplitude is that of an earlier call.
std::shared_ptr<CurveFindings> with_peak(const HbmHandle &h, const BranchHandle &curve, const Peak &peak,
                                         const Output &output) {
    if (curve.found && is_same(curve.found->output, output)) {
        const auto known = std::make_shared<CurveFindings>(*curve.found);
        known->peak = peak;
        return known;
    }
    return std::make_shared<CurveFindings>(
        findings_at(peak, output, *built(*h.basis), peak.branch->warnings));
}

/// An estimate at the peak that was looked for is that of its curve, too.
void keep_error(const BranchHandle &branch, const ErrorEstimate &e, const Output &output) {
    if (!branch.found || branch.found->peak.branch != branch.core || !is_same(branch.found->output, output))
        return;
    const Peak &peak = branch.found->peak;
    branch.found->error = std::max(std::abs(e.amplitude.sum()) / peak.amplitude,
                                   std::abs(e.frequency_hz.sum()) / peak.frequency_hz);
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_hbm_create(plm_basis *basis, plm_hbm **hbm) {
    return call<BasisHandle>("plm_hbm_create", basis, [&](BasisHandle &b) {
        require_pointer(hbm, "hbm");
        *hbm = publish(std::make_shared<HbmHandle>(b.owner, find<BasisHandle>(basis)));
        return PLM_OK;
    });
}

plm_status plm_hbm_destroy(plm_hbm **hbm) {
    return destroy<HbmHandle>(hbm);
}

plm_status plm_hbm_sweep(plm_hbm *hbm, plm_branch **branch) {
    return search_call("plm_hbm_sweep", hbm, [&](HbmHandle &h) {
        require_pointer(branch, "branch");
        plm::CurveRecorder recorder = curve_recorder(h, nullptr);
        return deliver(h, solver(h).sweep(recorder), branch);
    });
}

plm_status plm_hbm_solve(plm_hbm *hbm, double frequency_hz, plm_branch *start, std::int64_t point,
                         plm_branch **branch) {
    return search_call("plm_hbm_solve", hbm, [&](HbmHandle &h) {
        require_finite(frequency_hz, "frequency_hz");
        if (!(frequency_hz > 0))
            bad_argument("frequency_hz", -1, plm::format("frequency_hz is %g; it must be > 0", frequency_hz));
        require_pointer(branch, "branch");
        std::shared_ptr<BranchHandle> first;
        if (start) {
            first = own_branch(h, start, "start");
            require_point(*first->core, point);
        }
        return deliver(h, solver(h).solve(frequency_hz, first ? first->core.get() : nullptr, point), branch);
    });
}

plm_status plm_hbm_find_peak(plm_hbm *hbm, plm_branch *branch, std::int64_t dof, std::int32_t measure,
                             std::int32_t harmonic, double *frequency_hz, double *amplitude,
                             plm_branch **peak) {
    return search_call("plm_hbm_find_peak", hbm, [&](HbmHandle &h) {
        const std::shared_ptr<BranchHandle> curve = own_branch(h, branch, "branch");
        require_measure(*curve->core, dof, measure, harmonic);
        require_pointer(frequency_hz, "frequency_hz");
        require_pointer(amplitude, "amplitude");
        const plm::Output output = {dof, static_cast<plm::Measure>(measure), harmonic};
        const plm::Peak found = solver(h).find_peak(*curve->core, dof, output.measure, harmonic);
        const double highest[] = {found.frequency_hz, found.amplitude};
        plm::require_finite_result(highest, 2, "frequency_hz, amplitude");
        Outcome outcome = deliver(h, found.branch->warnings);
        const auto known = with_peak(h, *curve, found, output);
        if (peak) {
            const auto top = std::make_shared<BranchHandle>(h.owner, found.branch);
            top->found = known;
            *peak = publish(top);
        }
        curve->found = known;
        *frequency_hz = found.frequency_hz, *amplitude = found.amplitude;
        return outcome;
    });
}

plm_status plm_hbm_estimate_error(plm_hbm *hbm, plm_branch *branch, std::int64_t point, std::int64_t dof,
                                  std::int32_t measure, std::int32_t harmonic, double *amplitude,
                                  double *frequency_hz) {
    return search_call("plm_hbm_estimate_error", hbm, [&](HbmHandle &h) {
        const std::shared_ptr<BranchHandle> curve = own_branch(h, branch, "branch");
        require_point(*curve->core, point);
        require_measure(*curve->core, dof, measure, harmonic);
        const plm::ErrorEstimator estimator(
            plm::unreduced_basis(built(*h.basis), h.owner->watch())->reduced(), *curve->core, h.hbm_options);
        const plm::Output output = {dof, static_cast<plm::Measure>(measure), harmonic};
        const plm::ErrorEstimate e = estimator.estimate(point, dof, output.measure, harmonic);
        const auto put = [](const plm::ErrorParts &parts, double *out) {
            if (out) out[0] = parts.basis, out[1] = parts.contact, out[2] = parts.harmonics;
        };
        double all[6];
        put(e.amplitude, all), put(e.frequency_hz, all + 3);
        if (e.complete())
            plm::require_finite_result(all, 6, "amplitude, frequency_hz"); // else NaN where unknown
        put(e.amplitude, amplitude);
        put(e.frequency_hz, frequency_hz);
        keep_error(*curve, e, output);
        plm::Warnings warnings;
        if (!e.complete())
            warnings.add(PLM_REASON_NO_CONTRACTION,
                         std::string(e.known
                                         ? "what the harmonics beyond those solved for change at this point"
                                         : "the error of this point") +
                             " cannot be estimated (NaN): the steps towards the better solution do not "
                             "contract, so that the error may be large; give the basis more vectors, the "
                             "curve more harmonics or the contact less stiffness, and compare");
        return deliver(h, std::move(warnings));
    });
}

plm_status plm_hbm_refine_basis(plm_hbm *hbm, std::int64_t dof, std::int32_t measure, std::int32_t harmonic,
                                double tolerance, plm_basis **refined, double *error) {
    return search_call("plm_hbm_refine_basis", hbm, [&](HbmHandle &h) {
        const std::shared_ptr<const plm::Basis> &basis = built(*h.basis);
        require_range(dof, 0, basis->model()->n_outputs() - 1, "dof");
        require_range(measure, PLM_PEAK, PLM_HARMONIC, "measure");
        const std::int64_t most =
            h.hbm_options.n_harmonics > 0 ? h.hbm_options.n_harmonics : h.hbm_options.max_harmonics;
        if (measure == PLM_HARMONIC) require_range(harmonic, 0, most, "harmonic");
        require_finite(tolerance, "tolerance");
        if (!(tolerance > 0 && tolerance < 1))
            bad_argument("tolerance", -1,
                         plm::format("tolerance is %g; a relative error in (0, 1) is wanted", tolerance));
        require_pointer(refined, "refined");
        plm::RefinementOptions o;
        o.hbm = h.hbm_options;
        o.output = {dof, static_cast<plm::Measure>(measure), harmonic};
        o.tolerance = tolerance;
        const plm::Refinement found = plm::refine(basis, o, h.owner->watch());
        if (!found.basis)
            throw plm::Error(PLM_ERR_CONVERGENCE, "no curve could be computed on a compressed basis")
                .argument("tolerance");
        const auto made = std::make_shared<BasisHandle>(h.owner, h.basis->model);
        made->basis_options = found.basis->options();
        made->core = found.basis;
        made->work = h.basis->work;
        *refined = publish(made);
        if (error) *error = found.error + basis->model()->space_options().reduction_error;
        if (found.met) return Outcome(found.warnings);
        if (!std::isfinite(found.error))
            return Outcome(
                PLM_NOT_CONVERGED, PLM_REASON_UNVERIFIED,
                plm::format("after %lld curves the steps to a better solution converge on none of a refined "
                            "basis: whether the tolerance %g is met is not known. Compare refined, the first "
                            "one made, with a larger one or with kind \"full\"",
                            static_cast<long long>(found.rounds), tolerance));
        return Outcome(
            PLM_NOT_CONVERGED, PLM_REASON_BASIS_TOO_SMALL,
            plm::format("after %lld curves the estimated error is still %.1e, above the tolerance %g; "
                        "refined is the best basis found. Raise the tolerance, or begin with a larger basis",
                        static_cast<long long>(found.rounds), found.error, tolerance));
    });
}
