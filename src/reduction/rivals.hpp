// The columns of the bases that compete with piecewise-linear modes on the same solver.
#pragma once
#include "reduction/mode_selection.hpp"

namespace plm {

/// For kinds bilinear, lelsm, lelsm_updated and discontinuity; needs at least one pair.
CollectedModes collect_rival_modes(const Space &space, const SelectionRule &rule, const BasisOptions &options,
                                   Watch watch);

} // namespace plm
