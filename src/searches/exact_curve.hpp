// A curve of exact motions: the orbits of the flow followed in the frequency, with their folds and
// bifurcations, without harmonics.
#pragma once
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "searches/curve_start.hpp"

namespace plm {

/// `start` is an exact motion.
void trace_exact_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch);

} // namespace plm
