// How wrong a point of a response curve is, without the unreduced solution: its contact forces are applied to
// the unreduced structure, and the gaps that answer differ from those of the reduced one. What this defect
// does to the solution follows from a step of Newton's method with the tangent of the unreduced structure,
// across the curve; a second one shows whether that tangent holds so far, and further ones renew it where
// not.
#pragma once
#include "hbm/options.hpp"
#include "hbm/system.hpp"
#include "motions/branch.hpp"
#include <cmath>

namespace plm {

/// Corrected less computed, by cause. Their sum is the estimate.
struct ErrorParts {
    double basis = 0;     // the reduced coordinates
    double contact = 0;   // contact sets that are others in the unreduced structure (second step)
    double harmonics = 0; // those beyond the ones solved for
    double sum() const { return basis + contact + harmonics; }
};
struct ErrorEstimate {
    ErrorParts amplitude;    // of the DOF asked for
    ErrorParts frequency_hz; // shift of the curve along the frequency
    // Parts whose steps do not contract are NaN: that of the harmonics, or all of them
    bool known = true; // false: all of them
    // Of the whole structure's motion, where exact motions are compared; empty: not known
    vector<std::complex<double>> multipliers;
    bool complete() const { return std::isfinite(amplitude.sum()); }
};

class ErrorEstimator {
  public:
    /// full: the unreduced structure (project_whole of its contact space). The options are those of the
    /// curve. Exact motions are compared with that of the whole structure where this takes no more than
    /// `affordable` flops; else by harmonic balance, with at most their max_harmonics.
    ErrorEstimator(std::shared_ptr<const ReducedModel> full, const Branch &branch, const HbmOptions &options,
                   double affordable = 3e10);
    /// Whether a point is compared with the whole structure's own exact motion.
    bool moves_whole(std::int64_t point) const;
    /// PLM_ERR_CONVERGENCE when the tangent is singular.
    ErrorEstimate estimate(std::int64_t point, std::int64_t dof, Measure measure, std::int64_t harmonic,
                           bool with_harmonics = true) const;
    /// The point in the coordinates of `full` after the correction, or as computed where that does not
    /// contract.
    BranchPoint corrected(std::int64_t point) const;

  private:
    ErrorEstimate by_exact_motion(std::int64_t point, std::int64_t dof, Measure measure,
                                  std::int64_t harmonic) const;

    const Branch &branch_;
    std::shared_ptr<const ReducedModel> full_;
    HbmOptions options_;
    double affordable_;
};

} // namespace plm
