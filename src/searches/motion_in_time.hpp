// What harmonic balance is off by where no exact motion is near it, as in a tangle of bounces: the exact flow
// is followed for some periods from the solution's own state. Its mean contact forces obey the same balance
// as those of a periodic motion, so what they differ by from the solution's own is what the balance lacks.
#pragma once
#include "hbm/harmonic_tail.hpp"
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"

namespace plm {

/// What the motion in time would change at a solution of harmonic balance with the harmonics of `options`, as
/// harmonic_change(), the structure being that of `reduced` (P_0 = P, viscous damping).
HarmonicChange change_in_time(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                              const BranchPoint &point, Watch watch);

} // namespace plm
