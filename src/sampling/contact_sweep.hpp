// The evolution of the contact area along dX = offset + alpha dV (paper, eq. (5)) and the choice of a few
// samples.
#pragma once
#include "linalg/memory.hpp"
#include <cstdint>
#include <vector>

namespace plm {

/// The sweep dX = dX_0 + alpha dV of one dominant mode: Z + 1 contact sets at most.
struct ContactSweep {
    vector<double> offset;                       // dX_PS (rest penetration) or dX_0 (static offset), per pair
    bool offset_is_rest = false;                 // which of the two
    vector<double> thresholds;                   // the alphas where a pair switches, ascending, ties merged
    std::vector<vector<std::int64_t>> switching; // pairs that switch at each threshold
    std::vector<vector<char>> samples; // thresholds.size() + 1 contact sets, from alpha_min to alpha_max
    vector<double> alpha;              // a representative alpha inside each interval
};

struct SelectedSample {
    vector<char> closed;
    std::int64_t dominant = 0;    // which dominant mode's sweep
    std::int64_t sweep_index = 0; // position in that sweep
    bool complement = false;
    std::int64_t n_closed = 0;
};

/// What moves a pair by less than this share of the largest gap motion does not move it.
constexpr double unmoved = 1e-9;

/// All contact sets from alpha -> -infinity to +infinity. A pair that dV leaves unmoved never switches: its
/// offset says whether it is closed. Thresholds that differ by less than 1e-6 of their size are one
/// (symmetric meshes).
ContactSweep sweep_contact(const vector<double> &offset, bool offset_is_rest,
                           const vector<double> &mode_penetration);

/// Positions in the sweep's list of n_samples equally spaced samples, ascending, without duplicates.
/// with_ends: first and last included; n_samples = 1: the sample at alpha = 0.
vector<std::int64_t> equally_spaced(const ContactSweep &sweep, std::int64_t n_samples, bool with_ends);

/// Position of the sample at alpha = 0: the contact set at rest when the offset is the rest penetration.
std::int64_t position_at_rest(const ContactSweep &sweep);

/// The selected samples of all sweeps, then (complements) those with every status inverted; no contact set
/// twice. with_rest: where the offset is the rest penetration, the selected position nearest to rest is moved
/// there, since small vibration takes place in that contact set alone.
std::vector<SelectedSample> select_samples(const std::vector<ContactSweep> &sweeps, std::int64_t n_samples,
                                           bool with_ends, bool complements, bool with_rest);

} // namespace plm
