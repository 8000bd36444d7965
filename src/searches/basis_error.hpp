// What a basis does to the points of a curve, by the estimate of their error.
#pragma once
#include "reduction/basis.hpp"
#include "searches/error_estimate.hpp"

namespace plm {

/// The DOF that moves most at a point: what a curve is judged by where none is named.
Output most_moving(const Branch &branch, std::int64_t point);

/// Up to `wanted` points spread over a curve by their number, which its curvature sets.
vector<std::int64_t> spread_over(const Branch &branch, std::int64_t wanted);

/// Of one point: of the amplitude over `peak`, of the frequency over itself, the larger one; infinite where
/// the steps to the better solution do not contract.
double basis_error(const ErrorEstimator &estimator, const Branch &branch, std::int64_t point,
                   const Output &output, double peak);

/// What an estimate may cost: some points of a curve, or more than the curve.
enum class Patience { little, much };

/// The same of one point and its own amplitude; infinite where it does not contract or is too
/// far off for it, NaN where it would cost
/// more, or a basis cannot be judged so.
double basis_error_at(const std::shared_ptr<const Basis> &basis, const HbmOptions &options,
                      const Branch &branch, std::int64_t point, const Output &output, Patience patience,
                      Watch watch);

} // namespace plm
