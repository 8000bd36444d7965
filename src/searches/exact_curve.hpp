// A curve of exact motions: the orbits of the flow followed in the frequency, with their folds and
// bifurcations, without harmonics.
#pragma once
#include "searches/curve.hpp"

namespace plm {

/// As trace_curve(), from a point that is an exact motion.
void trace_exact_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch);

} // namespace plm
