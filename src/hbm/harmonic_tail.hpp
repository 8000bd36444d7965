// What harmonics beyond those solved for would add, from the exact contact force of the solution found, and
// what they would change in the harmonics solved for. The penetration's harmonics tell; those of the output
// mislead.
#pragma once
#include "hbm/system.hpp"
#include "motions/branch.hpp"
#include "reduction/reduced_model.hpp"

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

/// What the next harmonics would change at a point, by one step of Newton's method across the curve with
/// their contact forces, and they themselves.
struct HarmonicChange {
    Matrix motion;    // r x 2 (2 H + 2): reduced coordinates of harmonics 1 ... 2 H + 2
    double shift = 0; // of the frequency, relative
};

/// `system` is linearised at the point, whose unknowns are x.
HarmonicChange harmonic_change(const ReducedModel &reduced, const BranchPoint &point,
                               std::int64_t period_multiple, const HarmonicContent &content,
                               HbmSystem &system, const double *x);

/// The largest of: the change as a share of the structure's motion (norm of M), of the frequency, and of the
/// motion of each DOF that a contact pair holds, since a part that is struck may move little against the part
/// that is driven. (A contact DOF that moves less than `least_motion` of the one that moves most counts as
/// moving that much: what nearly stands still asks for no harmonics.)
double harmonic_error(const ReducedModel &reduced, const BranchPoint &point, const HarmonicChange &change);
constexpr double least_motion = 0.03;

/// The same for one DOF of the model (base 0): in the motion or the harmonic that the measure is of, or in
/// the frequency. 0 when it does not move.
double harmonic_error_at(const ReducedModel &reduced, const BranchPoint &point, const HarmonicChange &change,
                         std::int64_t dof, Measure measure, std::int64_t harmonic);

} // namespace plm
