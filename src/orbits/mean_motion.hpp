// What the structure does in time from a point's state on, on the average of some periods: where nothing
// repeats, as in a tangle of bounces, it is all that can be said.
#pragma once
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"

namespace plm {

/// Of the periods of the response after `settling` ones: Fourier coefficients a_0, a_1, b_1, ... of the
/// static coordinates (r_0) and of the forces of the pairs (Z), each with as many harmonics as asked for.
struct MeanMotion {
    Matrix motion, force;
};
struct MeanOver {
    std::int64_t settling, counted; // periods of the response
};
/// `reduced`: a widened model. PLM_CANCELLED where the effort ends before.
MeanMotion mean_motion(std::shared_ptr<const ReducedModel> reduced, const BranchPoint &point,
                       std::int64_t period_multiple, MeanOver periods, std::int64_t n_harmonics, Watch watch);

/// Whether a whole curve by harmonics tells of a larger motion than a part of one by exact motions: its
/// highest one is larger, and the structure goes on so in time, if not exactly. Where no motion is near, as
/// in a tangle of bounces, it falls to what there is.
bool says_more(const Branch &curve, const Branch &part, Watch watch);

} // namespace plm
