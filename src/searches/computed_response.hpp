// The whole way from a model to its peak for one number, the accuracy: sampler, a curve on the unreduced
// structure (or, where that is large, on a basis and again on a refined one), peak, and the error of all
// that.
#pragma once
#include "reduction/basis.hpp"
#include "searches/larger_motion.hpp"

namespace plm {

struct ComputedResponse {
    std::shared_ptr<const Basis> basis;
    HbmOptions options; // of the curve
    std::shared_ptr<const Branch> curve;
    Peak peak;
    std::optional<LargerMotion> larger;  // beside the curve
    bool looked_beside = false;          // for one, to the end
    std::optional<MotionInTime> in_time; // larger than the peak
    /// Of the peak, relative: by the basis, as estimated, and what the host states of its own reduction; NaN:
    /// not known, or the curve ended early.
    double error = 0;
    double setup = 0;  // what the first basis cost, flops
    Warnings warnings; // of all steps, as far as the estimate does not know better
};

/// known: an earlier contact space of the model, or null. effort: what the search may cost, flops, unless the
/// first basis cost more.
ComputedResponse compute_response(std::shared_ptr<const Model> model, std::shared_ptr<const Space> known,
                                  const Output &output, double accuracy, double effort, Watch watch);

} // namespace plm
