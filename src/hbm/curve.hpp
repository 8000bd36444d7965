// One response curve from a first point on: the continuation with the number of harmonics and the unknowns
// chosen again wherever the response asks for it, and with the stability of its points.
#pragma once
#include "hbm/continuation.hpp"
#include "hbm/harmonic_tail.hpp"
#include "linalg/monitor.hpp"

namespace plm {

struct CurveStart {
    BranchPoint point;
    /// Not empty: a second point beside the first, on the side to which the curve is followed; otherwise
    /// options.upward decides.
    std::vector<BranchPoint> towards;
    bool away = false; // the curve leaves on the other side: on past `point`, as one comes from towards[0]
};

/// Appends the curve's points to `branch` and sets its ending and its cost. n_harmonics of the options is the
/// number to begin with when they are chosen by point (options.n_harmonics = 0: the start's).
void trace_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch);

/// Solves at the frequency of `point` with more harmonics until the next ones are negligible (or the allowed
/// number is reached): what one point needs. `point` stays where no solution with more is found.
void settle_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                      BranchPoint &point, Watch watch = Watch());

/// Harmonics of a point per period of the excitation: what HbmOptions::n_harmonics counts.
std::int64_t harmonics_of(const BranchPoint &point, std::int64_t period_multiple);

/// `options` with the harmonics, the force and the form of the contact law by which a point of a branch was
/// solved, whatever the options say now.
HbmOptions options_at(const BranchPoint &point, const HbmOptions &options);

/// Sets point.harmonic_tail and harmonic_error of a solution, in the harmonics that it was solved with;
/// returns what the next ones are.
HarmonicContent measure_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                                  BranchPoint &point);

/// Options with the number of harmonics to begin with in place of 0.
HbmOptions with_first_harmonics(const ReducedModel &reduced, const HbmOptions &options);

} // namespace plm
