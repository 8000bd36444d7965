// LELSM, the local equivalent linear stiffness method (Butcher and Lu 2007, Nonlinear Dynamics 49, 375-399),
// in its form that does not depend on the amplitude: the springs of the contact are replaced by linear ones
// which give the system, mode by mode, the bilinear frequency of the piecewise-linear one, 2 w_o w_s / (w_o +
// w_s) with the i-th frequencies w_o of the open and w_s of the sliding system. Where several pairs share the
// contact, all their stiffnesses are scaled by one factor s_i: the paper has one spring or a few, each with a
// frequency relation of its own. Initial gap and pre-load do not enter, as in the paper's
// amplitude-independent form.
#pragma once
#include "reduction/mode_selection.hpp"

namespace plm {

struct EquivalentModes {
    Matrix columns; // i-th mode of the system with springs s_i k_n, mass-normalised
    vector<double>
        frequency_hz;        // its frequency, the bilinear one; 0 for a rigid-body mode of the open system
    vector<double> coupling; // s_i, in [0, 1]
};

/// One mode for every i whose bilinear frequency the rule keeps. Throws PLM_ERR_ARGUMENT when there is none.
EquivalentModes lelsm_modes(const Space &space, const SelectionRule &rule, Watch watch);

} // namespace plm
