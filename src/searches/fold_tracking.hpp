// The curve of folds of a response over (frequency, force). Where it turns back in the force, an isolated
// branch is born or joins another one: these are the ends of the range of forces in which the branch exists.
#pragma once
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"

namespace plm {

/// Corrects (x, omega) to a fold at the force scale given, by the equations that `near`, a fold, solves:
/// those of harmonic balance with its harmonics, or of exact motions. False: `point` is unchanged.
bool correct_fold(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, double force,
                  const BranchPoint &near, BranchPoint &point);

struct FoldOptions {
    HbmOptions hbm;                      // with the tolerance and the steps of a curve
    double force_min = 0, force_max = 0; // range of force scales
    bool upward = true;                  // in the force, at the start
    bool stop_at_turn = false;           // at the first extremum of the force
};

/// Follows the folds from `fold` (a located one: PLM_BIFURCATION_FOLD), by the equations that it solves.
/// Points carry force scale and omega; those with PLM_BIFURCATION_FOLD are extrema of the force. Null when
/// the start cannot be corrected. Where it is stopped, the folds found by then.
std::shared_ptr<Branch> follow_folds(std::shared_ptr<const ReducedModel> reduced, const FoldOptions &options,
                                     const BranchPoint &fold, Watch watch);

/// The same to both sides of the fold, as one curve: the side of smaller forces first, backwards. It ends for
/// the reason of the side that did not get to the end of the range, if any.
std::shared_ptr<Branch> follow_folds_both_ways(std::shared_ptr<const ReducedModel> reduced,
                                               FoldOptions options, const BranchPoint &fold, Watch watch);

} // namespace plm
