// What harmonics beyond those solved for would add, from the exact contact force of the solution found: the
// penetration's harmonics tell, those of the output mislead.
#pragma once
#include "hbm/branch.hpp"

namespace plm {

struct HarmonicContent {
    double tail = 0;      // |gaps' motion in harmonics H + 1 ... 2 H + 2| over that in 1 ... H
    double top = 0;       // the same for the upper two fifths of the harmonics solved for
    Matrix tail_response; // r x 2 (H + 2): reduced coordinates of harmonics H + 1 ... 2 H + 2
};

/// point.n_harmonics = H harmonics of a response with `period_multiple` excitation periods are looked at.
HarmonicContent harmonic_content(const ReducedModel &reduced, const BranchPoint &point,
                                 std::int64_t period_multiple);

} // namespace plm
