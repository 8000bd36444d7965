// Pseudo-arc-length continuation of R(x, p) = 0, p the frequency of a response curve, the force on the way
// from rest to a first solution, ..., in a metric where 1 is the width of the range of p or the largest
// dynamic response so far. Folds and branch points are located on the way, and whatever else changes the sign
// of a test function of the path's owner.
#pragma once
#include "paths/newton.hpp"
#include "paths/path.hpp"
#include "paths/path_progress.hpp"

namespace plm {

/// Where a path begins: a solution, and the side on which it is left.
struct PathStart {
    PathState at = {};
    double residual = 0;
    PathState direction = {}; // of no unknowns: by PathOptions::upward
    double scale = 0;         // of the metric; 0: the response at x
    bool record = true;       // false: a path that goes on, its first point is known already
    // not of no unknowns: the path is closed when it comes back here in this direction; otherwise at x
    PathState end = {}, end_direction = {};
};

struct PathOutcome : PathProgress {
    std::int32_t end_reason = reason::none; // PLM_REASON_NONE: interrupted by its owner
    std::int64_t failed_now = 0;            // of failed_steps: by this call
    NewtonWork work;
};

/// Follows the path from `start` until it leaves the range, closes, or cannot go on. The last point lies on
/// the boundary of the range when it was left (PLM_REASON_RANGE_END; PLM_REASON_TURNED_BACK when it came back
/// to where it began, against the direction in which it had left). PLM_REASON_CROSSED_OVER: it goes round a
/// closed curve that does not begin at its start.
PathOutcome follow_path(Residual &system, const PathOptions &options, const PathStart &start,
                        PathOwner &owner);
/// The same path on from where its owner had interrupted it. PLM_ERR_ARGUMENT where that is not one of these
/// equations.
PathOutcome go_on_with_path(Residual &system, const PathOptions &options, const PathProgress &from,
                            PathOwner &owner);

} // namespace plm
