// What harmonics beyond those solved for would add, from the exact contact force of the solution found, and
// what they would change in the harmonics solved for. The penetration's harmonics tell; those of the output
// mislead.
#pragma once
#include "hbm/system.hpp"

namespace plm {

struct HarmonicContent {
    double tail = 0;      // |gaps' motion in harmonics H + 1 ... 2 H + 2| over that in 1 ... H
    double top = 0;       // the same for the upper two fifths of the harmonics solved for
    Matrix tail_response; // r x 2 (H + 2): reduced coordinates of harmonics H + 1 ... 2 H + 2
    Matrix force_change;  // Z x (2H + 1): what they change in the contact forces of harmonics 0 ... H
};

/// point.n_harmonics = H harmonics of a response with `period_multiple` excitation periods are looked at.
HarmonicContent harmonic_content(const ReducedModel &reduced, const BranchPoint &point,
                                 std::int64_t period_multiple);

/// Estimate of what the next harmonics would change at a point, as a share of the structure's motion (norm of
/// M) or, if that is more, of the frequency: one step of Newton's method across the curve with their contact
/// forces, and they themselves. `system` is linearised at the point, whose unknowns are x.
double harmonic_error(const ReducedModel &reduced, const BranchPoint &point, std::int64_t period_multiple,
                      const HarmonicContent &content, HbmSystem &system, const double *x);

} // namespace plm
