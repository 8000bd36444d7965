// What a basis does to the points of a curve, by the estimate of their error.
#pragma once
#include "reduction/basis.hpp"
#include "searches/error_estimate.hpp"

namespace plm {

/// Of one point: of the amplitude over `peak`, of the frequency over itself, the larger one; infinite where
/// the steps to the better solution do not contract. `multipliers`, where asked for and known, becomes those
/// of the whole structure's motion.
double basis_error(const ErrorEstimator &estimator, const Branch &branch, std::int64_t point,
                   const Output &output, double peak, vector<std::complex<double>> *multipliers = nullptr);

/// Whether a model made of a basis, itself or widened, spans all of the basis' space: a curve on it lacks
/// nothing by the basis.
bool is_unreduced(const ReducedModel &reduced, const Basis &basis);

/// What a curve of exact motions has cost, estimated: what it may cost to judge it.
double flops_of(const Branch &curve, const HbmOptions &options);

/// The same of one point and its own amplitude, within `flops`; infinite where it does not contract or is too
/// far off for it, NaN where it would cost more, or a basis cannot be judged so.
double basis_error_at(const std::shared_ptr<const Basis> &basis, const HbmOptions &options,
                      const Branch &branch, std::int64_t point, const Output &output, double flops,
                      Watch watch, vector<std::complex<double>> *multipliers = nullptr);

/// How far the largest Floquet multipliers of a curve of exact motions are from those of the whole structure,
/// by its highest motion and the one whose multiplier is nearest to the unit circle; 0 where the basis is
/// complete, and where that would cost more than the flops.
double multiplier_error_of(const std::shared_ptr<const Basis> &basis, const HbmOptions &options,
                           const Branch &curve, double flops, Watch watch);

} // namespace plm
