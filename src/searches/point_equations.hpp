// The equations that the points of a curve solve, whichever they are.
#pragma once
#include "hbm/options.hpp"
#include "motions/periodic_equations.hpp"

namespace plm {

/// Those that `point` solves; options: with the force, the period and the harmonics that it has.
std::unique_ptr<PeriodicEquations> equations_of(std::shared_ptr<const ReducedModel> reduced,
                                                const HbmOptions &options, const BranchPoint &point);

} // namespace plm
