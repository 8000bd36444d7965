// Nonlinear modes by the extended periodic motion concept (Krack 2015): periodic motions without excitation,
// M q'' + C q' + K q + B^T N = P + 2 xi omega M q', where the negative damping makes up for what C
// dissipates: xi is the mode's damping ratio. Frequency and damping over the amplitude; the pre-load stays.
#pragma once
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"
#include "motions/motion_measures.hpp"

namespace plm {

struct NonlinearModeOptions {
    HbmOptions hbm; // harmonics (0: as many as the largest motion needs), tolerance, steps; its frequency
                    // range and force scale are not used
    std::int64_t mode = 0; // 1, 2, ...: elastic modes about rest; 0: the nearest to frequency_hz
    double frequency_hz = 0;
    std::int64_t dof = -1; // the path ends where its first harmonic reaches dof_amplitude_max; -1: see below
    double dof_amplitude_max = 0;
    // psi . M a_1 with psi of unit modal mass (sqrt(mass) x length). 0: from half the amplitude at which the
    // first pair changes its state to a hundred times as much; needs pre-load or gap
    double amplitude_min = 0, amplitude_max = 0;
};

/// One entry per point of the branch; its points have force scale 0.
struct NonlinearMode {
    std::shared_ptr<Branch> branch;
    vector<double> amplitude;
    std::vector<MotionMeasures> measures;
};

/// Throws PLM_ERR_CONVERGENCE when no motion is found at the smallest amplitude.
NonlinearMode follow_nonlinear_mode(std::shared_ptr<const ReducedModel> reduced,
                                    const NonlinearModeOptions &options, Watch watch);

} // namespace plm
