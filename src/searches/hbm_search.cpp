// The searches of Hbm: checks, and the options they run with.
#include "hbm/harmonic_choice.hpp"
#include "hbm/nonlinear_mode.hpp"
#include "orbits/orbit_points.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/curve.hpp"
#include "searches/fold_tracking.hpp"
#include "searches/hbm.hpp"
#include "searches/isolated.hpp"
#include "searches/marching_search.hpp"
#include "searches/motion_choice.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

namespace {

// Resonance is told by the phase of the motion against the excitation's force.
void require_still_walls(const ReducedModel &reduced) {
    if (reduced.whole_contact().moves())
        throw Error(
            status::argument,
            "the gaps of the model move, and resonance is told by the phase "
            "of the motion against the excitation's force, which says nothing of what moving walls do; "
            "compute curves at several force scales, or start one at a motion that a transient finds")
            .argument("hbm");
}

} // namespace

IsolatedSearch Hbm::find_isolated(const Branch &given, double force_max) const {
    const auto on_basis = on_whole_basis(given, options_, 0, -1);
    const Branch &main = *on_basis;
    const std::shared_ptr<const ReducedModel> reduced = model_of(main, "main_branch");
    require_still_walls(*reduced);
    HbmOptions options = options_;
    options.period_multiple = main.period_multiple();
    // exact motions have other coordinates there, and what is found is held against the main branch
    if (!reduced->same_static) {
        if (options.motion == MotionKind::exact)
            throw Error(
                status::argument,
                "the main branch has solutions of harmonic balance, and exact motions differ from them "
                "on a basis with a pre-load; hand over a curve of exact motions, or set motion to "
                "harmonics")
                .argument("main_branch");
        if (options.n_harmonics == 0) options.n_harmonics = main.n_harmonics() / options.period_multiple;
    }
    // the curve may have gone on past the window to its peak
    for (const BranchPoint &p : main.points()) {
        options.frequency_min_hz = std::min(options.frequency_min_hz, p.omega / (2 * M_PI));
        options.frequency_max_hz = std::max(options.frequency_max_hz, p.omega / (2 * M_PI));
    }
    return plm::find_isolated(reduced, options, main, force_max, watch_,
                              given.reduced().from ? given.reduced_model() : nullptr);
}

std::vector<Backbone> Hbm::find_backbones(double force_max) const {
    require_still_walls(*reduced_);
    BackboneOptions options;
    options.hbm = with_first_harmonics(*reduced_, options_);
    options.force_max = force_max;
    options.exact = reduced_->same_static && prefers_exact(*reduced_, options_);
    std::vector<Backbone> found = PhaseResonance(reduced_, options, watch_).backbones();
    if (!options.exact && options_.n_harmonics == 0)
        for (const Backbone &backbone : found) warn_of_backbone(options_, watch_, *backbone.branch);
    return found;
}

std::shared_ptr<const Branch> Hbm::track_fold(const Branch &given, std::int64_t point, double force_min,
                                              double force_max) const {
    const auto on_basis = on_whole_basis(given, options_, point, point);
    const Branch &branch = *on_basis;
    const BranchPoint &fold = branch.points().at(static_cast<std::size_t>(point));
    const std::shared_ptr<const ReducedModel> reduced = model_of(branch, "branch");
    if (fold.bifurcation != bifurcation::fold)
        throw Error(status::argument, format("point %lld is no fold; see the branch's \"bifurcation\"",
                                             static_cast<long long>(point)))
            .argument("point")
            .index(point);
    if (!(fold.force_scale >= force_min && fold.force_scale <= force_max))
        throw Error(status::argument, format("the fold's force scale %g is outside the range [%g, %g]",
                                             fold.force_scale, force_min, force_max))
            .argument(fold.force_scale < force_min ? "force_min" : "force_max");
    FoldOptions options;
    options.hbm = options_;
    options.hbm.period_multiple = branch.period_multiple();
    options.force_min = force_min;
    options.force_max = force_max;
    const auto folds = follow_folds_both_ways(reduced, options, fold, watch_);
    if (!folds)
        throw Error(status::convergence, "the fold could not be corrected at its own force")
            .argument("point")
            .reason(reason::start_failed);
    return folds;
}

std::vector<std::shared_ptr<Branch>>
Hbm::find_by_marching(const std::vector<std::shared_ptr<const Branch>> &given, std::int64_t n_frequencies,
                      std::int64_t n_states) const {
    std::vector<std::shared_ptr<const Branch>> known;
    for (const auto &branch : given)
        known.push_back(branch->reduced().from ? on_whole_basis(*branch, options_, 0, -1) : branch);
    MarchingOptions options;
    options.hbm = options_;
    options.n_frequencies = n_frequencies;
    options.scales = {0};
    for (std::int64_t i = 0; i < n_states; ++i) options.scales.push_back(std::exp2(static_cast<double>(i)));
    std::shared_ptr<const ReducedModel> reduced = reduced_;
    for (const auto &branch : known) {
        const auto of_this = model_of(*branch, "known");
        if (branch != known.front() && of_this != reduced)
            throw Error(status::argument, "the known branches are exact motions and solutions of harmonic "
                                          "balance, which differ on a basis with a pre-load; hand over those "
                                          "of one kind (\"motion\" of the hbm)")
                .argument("known");
        reduced = of_this;
    }
    return search_by_marching(reduced, options, known, watch_).branches;
}

std::shared_ptr<const Branch> Hbm::find_nonlinear_mode(std::int64_t mode, std::int64_t dof,
                                                       double amplitude_max) const {
    NonlinearModeOptions options;
    options.hbm = options_;
    options.mode = mode;
    options.dof = dof;
    options.dof_amplitude_max = amplitude_max;
    return follow_nonlinear_mode(reduced_, options, watch_).branch;
}

} // namespace plm
