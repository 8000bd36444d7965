// The whole way from a model to its peak for one number, the accuracy: sampler, basis, curve, peak, and again
// with a larger basis until the error that the basis makes is estimated to be small enough.
#pragma once
#include "reduction/basis.hpp"
#include "searches/larger_motion.hpp"
#include <functional>

namespace plm {

struct ComputedResponse {
    std::shared_ptr<const Basis> basis;
    HbmOptions options; // of the curve
    std::shared_ptr<const Branch> curve;
    Peak peak;
    std::optional<LargerMotion> larger; // beside the curve
    /// Of the peak, relative: by the basis, as estimated, and what the host states of its own reduction; NaN:
    /// not known, or the curve ended early.
    double error = 0;
    Warnings warnings; // of all steps, as far as the estimate does not know better
};

/// What the search may cost, flops, by what the first basis cost.
using Allowance = std::function<double(double setup)>;

/// known: an earlier contact space of the model, or null.
ComputedResponse compute_response(std::shared_ptr<const Model> model, std::shared_ptr<const Space> known,
                                  const Output &output, double accuracy, const Allowance &allowed,
                                  Watch watch);

} // namespace plm
