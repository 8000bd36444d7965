// A response curve by harmonic balance: the continuation with the number of harmonics and the unknowns chosen
// again wherever the response asks for it, and with the stability of its points.
#pragma once
#include "hbm/harmonic_choice.hpp"
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "paths/continuation.hpp"
#include "searches/curve_start.hpp"

namespace plm {

/// n_harmonics of the options is the number to begin with when they are chosen by point (options.n_harmonics
/// = 0: the start's).
void trace_harmonic_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch);

} // namespace plm
