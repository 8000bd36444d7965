#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "capi/branch_end.hpp"
#include "capi/branch_input.hpp"
#include "capi/hbm_input.hpp"
#include <limits>

using namespace plm::capi;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

void require_force(double force, const char *name) {
    require_finite(force, name);
    if (force < 0)
        bad_argument(name, -1, plm::format("%s is %g; a force scale cannot be negative here", name, force));
}

/// own_branch() of an array's element: the argument's index says which.
BranchPtr own_curve(const HbmHandle &h, const plm_branch *branch, const char *name, std::int64_t index) {
    try {
        return own_branch(h, branch, name)->core;
    } catch (plm::Error &e) {
        e.index(index);
        throw;
    }
}

/// What the last search found is kept for plm_hbm_get_found, with all that its branches warn of.
plm_status keep_found(HbmHandle &h, std::vector<FoundBranch> found, std::int64_t *count) {
    plm::Warnings warnings;
    for (const FoundBranch &f : found) warnings.add(f.branch->warnings);
    if (plm::effort_left() <= 0)
        warnings.add(PLM_REASON_EFFORT,
                     "the effort allowed was spent before all was looked at: there may be more than what "
                     "was found. Raise the effort of the context");
    h.found = std::move(found);
    h.larger.reset(); // it was the first of those before
    *count = static_cast<std::int64_t>(h.found.size());
    return deliver(h, std::move(warnings));
}

/// What lies beside a curve is known of it from now on, where its peak is: for that it is compared with.
std::optional<plm::LargerMotion> keep_beside(const HbmHandle &h, const BranchHandle &curve,
                                             const plm::IsolatedSearch &search) {
    if (!curve.found) return {};
    const plm::CurveFindings &known = *curve.found;
    curve.found->larger = plm::find_larger_motion(
        {built(*h.basis), h.hbm_options, curve.core, known.peak.amplitude, known.output}, h.owner->watch(),
        &search.branches);
    curve.found->looked_beside = plm::effort_left() > 0;
    return curve.found->larger;
}

} // namespace

plm_status plm_hbm_switch_branch(plm_hbm *hbm, plm_branch *branch, std::int64_t point, std::int32_t mirrored,
                                 plm_branch **other) {
    return search_call("plm_hbm_switch_branch", hbm, [&](HbmHandle &h) {
        const std::shared_ptr<BranchHandle> curve = own_branch(h, branch, "branch");
        require_point(*curve->core, point);
        require_range(mirrored, 0, 1, "mirrored");
        require_pointer(other, "other");
        return deliver(h, solver(h).switch_branch(*curve->core, point, mirrored == 1), other);
    });
}

plm_status plm_hbm_find_isolated(plm_hbm *hbm, plm_branch *main_branch, double force_max,
                                 std::int64_t *count) {
    return search_call("plm_hbm_find_isolated", hbm, [&](HbmHandle &h) {
        const std::shared_ptr<BranchHandle> curve = own_branch(h, main_branch, "main_branch");
        require_force(force_max, "force_max");
        require_pointer(count, "count");
        const plm::IsolatedSearch search = solver(h).find_isolated(*curve->core, force_max);
        const std::optional<plm::LargerMotion> larger = keep_beside(h, *curve, search);
        std::vector<FoundBranch> found;
        if (larger) found.push_back({larger->curve, larger->force_low, larger->force_high});
        for (const plm::IsolatedBranch &b : search.branches)
            if (!larger || b.branch != larger->curve)
                found.push_back({b.branch, b.birth_force, b.merge_force});
        const plm_status status = keep_found(h, std::move(found), count);
        h.larger = larger;
        return status;
    });
}

plm_status plm_hbm_find_backbones(plm_hbm *hbm, double force_max, std::int64_t *count) {
    return search_call("plm_hbm_find_backbones", hbm, [&](HbmHandle &h) {
        require_force(force_max, "force_max");
        require_pointer(count, "count");
        const std::vector<plm::Backbone> backbones = solver(h).find_backbones(force_max);
        std::vector<FoundBranch> found;
        for (const plm::Backbone &b : backbones) found.push_back({b.branch, unknown, unknown});
        return keep_found(h, std::move(found), count);
    });
}

plm_status plm_hbm_get_found(plm_hbm *hbm, std::int64_t index, double *force_range, plm_branch **branch) {
    return call<HbmHandle>("plm_hbm_get_found", hbm, [&](HbmHandle &h) {
        const std::int64_t n = static_cast<std::int64_t>(h.found.size());
        if (n == 0)
            throw plm::Error(PLM_ERR_STATE, "this hbm has found no branch; search for some first")
                .argument("index");
        require_range(index, 0, n - 1, "index");
        require_pointer(branch, "branch");
        const FoundBranch &found = h.found[static_cast<std::size_t>(index)];
        *branch = publish_branch(h, found.branch);
        if (force_range) force_range[0] = found.force_low, force_range[1] = found.force_high;
        return PLM_OK;
    });
}

plm_status plm_hbm_track_fold(plm_hbm *hbm, plm_branch *branch, std::int64_t point, double force_min,
                              double force_max, plm_branch **folds) {
    return search_call("plm_hbm_track_fold", hbm, [&](HbmHandle &h) {
        const std::shared_ptr<BranchHandle> curve = own_branch(h, branch, "branch");
        require_point(*curve->core, point);
        require_force(force_min, "force_min");
        require_force(force_max, "force_max");
        if (!(force_max > force_min))
            bad_argument("force_max", -1,
                         plm::format("the range of forces [%g, %g] is empty", force_min, force_max));
        require_pointer(folds, "folds");
        return deliver(h, solver(h).track_fold(*curve->core, point, force_min, force_max), folds);
    });
}

plm_status plm_hbm_find_by_marching(plm_hbm *hbm, std::int64_t n_known, plm_branch *const *known,
                                    std::int64_t n_frequencies, std::int64_t n_states, std::int64_t *count) {
    return search_call("plm_hbm_find_by_marching", hbm, [&](HbmHandle &h) {
        require_range(n_known, 0, 1 << 20, "n_known");
        if (n_known > 0) require_pointer(known, "known");
        require_range(n_frequencies, 1, 1 << 20, "n_frequencies");
        require_range(n_states, 0, 30, "n_states");
        require_pointer(count, "count");
        std::vector<BranchPtr> curves;
        for (std::int64_t i = 0; i < n_known; ++i) curves.push_back(own_curve(h, known[i], "known", i));
        const auto branches = solver(h).find_by_marching(curves, n_frequencies, n_states);
        std::vector<FoundBranch> found;
        for (const auto &b : branches) found.push_back({b, unknown, unknown});
        return keep_found(h, std::move(found), count);
    });
}

plm_status plm_hbm_find_nonlinear_mode(plm_hbm *hbm, std::int64_t mode, std::int64_t dof,
                                       double amplitude_max, plm_branch **branch) {
    return search_call("plm_hbm_find_nonlinear_mode", hbm, [&](HbmHandle &h) {
        const plm::ReducedModel &reduced = *built(*h.basis)->reduced();
        require_range(mode, 1, reduced.size(), "mode");
        require_range(dof, 0, reduced.model->n_outputs() - 1, "dof");
        require_finite(amplitude_max, "amplitude_max");
        if (amplitude_max < 0)
            bad_argument(
                "amplitude_max", -1,
                plm::format("amplitude_max is %g; it must be positive, or 0 for automatic", amplitude_max));
        require_pointer(branch, "branch");
        return deliver(h, solver(h).find_nonlinear_mode(mode, dof, amplitude_max), branch);
    });
}
