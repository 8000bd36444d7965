// Rigid-body motion that neither supports nor contact hold: of a structure in free flight, or on rails. It
// moves no contact gap, so that periodic motion under balanced loads leaves its mean position open: zero
// here.
#pragma once
#include "reduction/reduced_model.hpp"

namespace plm {

/// Its directions in the static coordinates, orthonormal: r_0 x n.
Matrix free_motion(const ReducedModel &reduced);

/// S (r_0 x n) so that S S^T, added to the static stiffness, holds the mean position. Any
/// stiffness does, since no load acts along it; this one is that of the softest static coordinate.
Matrix hold_free_motion(const ReducedModel &reduced);

/// Throws PLM_ERR_CONVERGENCE with PLM_REASON_NO_EQUILIBRIUM when the mean of the loads drives such a motion:
/// no periodic one exists.
void require_balanced(const ReducedModel &reduced);

} // namespace plm
