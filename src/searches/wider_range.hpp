// A sweep whose range is an estimate goes on past its ends until the peak is inside.
#pragma once
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"
#include "motions/curve_recorder.hpp"
#include "reduction/sweep_range.hpp"

namespace plm {

/// Goes on past the end of a finished sweep where its largest response stands, half the width of the range at
/// a time, until it stands inside or `range` ends; says so in branch.warnings when it could not be brought
/// inside. asked: or null; the largest amplitude there, which may stand elsewhere, is then brought inside,
/// too. options: those of the sweep. recorder: of its curves, or null.
void bring_peak_inside(const HbmOptions &options, const SweepRange &range, const Output *asked, Watch watch,
                       Branch &branch, CurveRecorder *recorder);

} // namespace plm
