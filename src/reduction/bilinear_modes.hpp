// Bilinear modes: modes of the open and of the sliding system together (Saito and Epureanu 2011, Journal of
// Sound and Vibration 330, 3442-3457; Zucca and Epureanu 2014). Of the special boundary conditions of those
// papers, sliding is here what it is everywhere in the library: every pair closed through k_n along its
// normal.
#pragma once
#include "reduction/mode_selection.hpp"

namespace plm {

/// The modes kept of both systems; samples: open first, then sliding, none matched with a dominant mode.
/// Throws PLM_ERR_ARGUMENT when the rule keeps no mode at all.
CollectedModes collect_bilinear_modes(const Space &space, const SelectionRule &rule, Watch watch);

} // namespace plm
