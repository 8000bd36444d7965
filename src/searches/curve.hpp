// One response curve from a first point on: of exact motions from an exact motion (exact_curve.hpp),
// otherwise by harmonic balance (harmonic_curve.hpp).
#pragma once
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "searches/curve_start.hpp"

namespace plm {

/// Appends the curve's points to `branch` and sets its ending and its cost.
void trace_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch);

} // namespace plm
