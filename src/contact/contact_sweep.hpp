// The evolution of the contact area along dX = offset + alpha dV (paper, eq. (5)): the states of all pairs as
// one motion grows.
#pragma once
#include "contact/contact.hpp"
#include <vector>

namespace plm {

/// The sweep dX = dX_0 + alpha dV of one dominant mode: Z + 1 contact sets at most.
struct ContactSweep {
    vector<double> offset;                       // dX_PS (rest penetration) or dX_0 (static offset), per pair
    bool offset_is_rest = false;                 // which of the two
    vector<double> thresholds;                   // the alphas where a pair switches, ascending, ties merged
    std::vector<vector<std::int64_t>> switching; // pairs that switch at each threshold
    std::vector<PairStates> samples;             // thresholds.size() + 1, from alpha_min to alpha_max
    vector<double> alpha;                        // a representative alpha inside each interval
};

/// What moves a pair by less than this share of the largest gap motion does not move it.
constexpr double unmoved = 1e-9;

/// All contact sets from alpha -> -infinity to +infinity. A pair that dV leaves unmoved never switches: its
/// offset says which state it has. Thresholds that differ by less than 1e-6 of their size are one
/// (symmetric meshes).
ContactSweep sweep_contact(const vector<double> &offset, bool offset_is_rest,
                           const vector<double> &mode_penetration);

/// Position of the sample at alpha = 0: the contact set at rest when the offset is the rest penetration.
std::int64_t position_at_rest(const ContactSweep &sweep);

} // namespace plm
