// One response curve from a first point on: of exact motions from an exact motion, otherwise by harmonic
// balance (hbm/harmonic_curve.hpp).
#pragma once
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "motions/tracer.hpp"

namespace plm {

/// Appends the curve's points to `branch` and sets its ending and its cost. Where a step crossed over to a
/// closed curve beside it, it is followed anew with shorter ones. recorder: of the sweep that it belongs to,
/// or null; the branch has no points then.
void trace_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch,
                 CurveRecorder *recorder = nullptr);

} // namespace plm
