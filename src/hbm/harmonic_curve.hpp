// A response curve by harmonic balance: the continuation with the number of harmonics and the unknowns chosen
// again wherever the response asks for it.
#pragma once
#include "hbm/harmonic_equations.hpp"
#include "motions/tracer.hpp"

namespace plm {

/// n_harmonics of the options is the number to begin with when they are chosen by point (options.n_harmonics
/// = 0: the start's). multipliers: of its points; null: not
/// wanted. recorder: or null.
void trace_harmonic_curve(const HbmOptions &options, const CurveStart &start,
                          const MultipliersOf &multipliers, Watch watch, Branch &branch,
                          CurveRecorder *recorder);

} // namespace plm
