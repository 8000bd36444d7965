// The mean opening that vibration brings about where neither pre-load nor gap sets one (paper, 2.3.1; Zucca
// and Epureanu 2014): the penetration dX_0 under static contact forces proportional to |dV|.
#pragma once
#include "sampling/sampler_options.hpp"
#include "space/space.hpp"

namespace plm {

/// dX_0 = -B K_ref^-1 B^T |dV|, with K_ref the open or sliding stiffness. Rigid-body motion of the reference
/// system is left out.
vector<double> static_offset(const Space &space, LinearSystem system, const vector<double> &mode_penetration);

} // namespace plm
