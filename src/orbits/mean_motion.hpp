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

/// Mean square of the coordinates beside their mean, after the periods that damping takes to forget where the
/// motion began.
double square_after(const Branch &curve, const BranchPoint &begin, Watch watch);

} // namespace plm
