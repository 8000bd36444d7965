// One response curve from a first point on: the continuation with the number of harmonics and the unknowns
// chosen again wherever the response asks for it, and with the stability of its points.
#pragma once
#include "hbm/branch.hpp"
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "paths/continuation.hpp"
#include "searches/harmonic_choice.hpp"

namespace plm {

struct CurveStart {
    BranchPoint point;
    /// Not empty: a second point beside the first, on the side to which the curve is followed; otherwise
    /// options.upward decides.
    std::vector<BranchPoint> towards;
    bool away = false; // the curve leaves on the other side: on past `point`, as one comes from towards[0]
};

/// Appends the curve's points to `branch` and sets its ending and its cost. n_harmonics of the options is the
/// number to begin with when they are chosen by point (options.n_harmonics = 0: the start's). From an exact
/// motion, the curve is one of exact motions.
void trace_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch);

} // namespace plm
