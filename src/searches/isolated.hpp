// Isolated response branches: found without a hint where the phase-resonant backbone needs a force that is
// not monotonic in amplitude, entered there and traced as closed curves; the range of forces in which each
// exists from the stationary forces beside it, or from the folds tracked over the force.
#pragma once
#include "hbm/options.hpp"
#include "motions/branch.hpp"
#include "searches/phase_resonance.hpp"

namespace plm {

struct IsolatedBranch {
    std::shared_ptr<Branch> branch; // PLM_REASON_LOOP_CLOSED, or a curve that leaves the frequency range on
                                    // both sides and does not meet the main one in it
    bool closed = false;
    // force scales between which it exists; NaN: not found below force_max
    double birth_force = 0, merge_force = 0;
    bool tracked = false; // both ends are those of the curve, otherwise the extrema of the backbone
};

struct IsolatedSearch {
    std::vector<Backbone> backbones;
    std::vector<IsolatedBranch> branches;
    double seconds = 0;
};

/// Searches at options.force_scale, beside `main` (a sweep with the same options over the whole frequency
/// range). force_max: the largest force scale of the backbones, 0: 8 force_scale; a branch that merges above
/// it is missed; where the effort is spent, those found by then. smaller: `reduced` compressed to the motions
/// of the main branch, on which loops are traced that it has, too; null: none.
IsolatedSearch find_isolated(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                             const Branch &main, double force_max, Watch watch,
                             std::shared_ptr<const ReducedModel> smaller = nullptr);

/// For a loop that reaches so far from its first point, 0: not known: it must not be stepped over.
HbmOptions for_a_loop(HbmOptions options, double reach);

/// The curve through a solution at options.force_scale: a loop, or both ways to the ends of the frequency
/// range. Throws PLM_CANCELLED when the host wants to stop: half of the curve would be none.
std::shared_ptr<Branch> trace_through(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                                      const BranchPoint &start, Watch watch);

} // namespace plm
