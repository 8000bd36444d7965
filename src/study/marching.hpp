// A response curve by marching in time: the steady state at each of some frequencies, from the one before.
#pragma once
#include "orbits/transient.hpp"
#include "study/plane_curve.hpp"
#include "study/recipe.hpp"

namespace plm {

struct MarchedCurve {
    PlaneSamples samples;       // from the upper end of the range downwards
    std::int64_t unsettled = 0; // motions that were still changing after the periods allowed
};

/// n_frequencies spread evenly over the range with its ends, downwards, as a sweep goes by default; the first
/// one from the motion's present state. Options: as for a run of plm_transient, frequency and force excepted.
MarchedCurve march_curve(Transient &motion, const TransientOptions &options, const Output &output,
                         const FrequencyRange &range, std::int64_t n_frequencies, double force_scale,
                         Watch watch);

} // namespace plm
