// How converged the reference of a study is itself.
#pragma once
#include "hbm/options.hpp"
#include "study/plane_curve.hpp"

namespace plm {

struct HarmonicCheck {
    double frequency = 0, amplitude = 0; // relative change of the peak with twice its harmonics
};
/// The peak of the branch again with twice the harmonics of `peak`, on the curve corrected around its highest
/// point. PLM_ERR_CONVERGENCE when that fails.
HarmonicCheck check_harmonics(const Branch &branch, const Peak &peak, const HbmOptions &options,
                              const Output &output, Watch watch);

} // namespace plm
