// Updated LELSM modes with Ritz vectors (AL-Shudeifat and Butcher 2010, Nonlinear Dynamics 62,
// 821-840): modes of an equivalent linear system whose stiffnesses belong to the amplitude of the motion, and
// two kinds of static responses of it: to the excitation, and to the forces of the nonlinear elements.
//
// What differs from the paper, which has one or two symmetric elements (cubic, dead zone) without a bias:
// - the stiffness of a pair is that of its describing function about its mean penetration, which moves with
// the
//   amplitude (equivalent_motion.hpp);
// - one equivalent system, that of the resonance in the window, gives all modes: the paper iterates each mode
// by itself;
// - a force on one nonlinear element becomes the pattern of contact forces over all pairs in that motion, one
// for each
//   harmonic 0 .. n_harmonics; with one pair they are all parallel and conditioning leaves one, as in the
//   paper.
#pragma once
#include "reduction/equivalent_motion.hpp"
#include "reduction/mode_selection.hpp"

namespace plm {

struct UpdatedModes {
    Matrix columns; // modes kept, then the Ritz vectors (beside the modes), mass-normalised
    std::int64_t n_modes = 0;
    EquivalentMotion motion;
};

/// amplitude: as in EquivalentMotionOptions; with_loads: Ritz vectors for the excitation, too. Throws
/// PLM_ERR_ARGUMENT when the rule keeps no mode.
UpdatedModes updated_lelsm_modes(const Space &space, const SelectionRule &rule, double amplitude,
                                 bool with_loads, Watch watch);

} // namespace plm
