// The choice of a few samples from the sweeps of the contact area.
#pragma once
#include "contact/contact_sweep.hpp"

namespace plm {

struct SelectedSample {
    PairStates states;
    std::int64_t dominant = 0;    // which dominant mode's sweep
    std::int64_t sweep_index = 0; // position in that sweep
    bool complement = false;
};

/// Positions in the sweep's list of n_samples equally spaced samples, ascending, without duplicates.
/// with_ends: first and last included; n_samples = 1: the sample at alpha = 0.
vector<std::int64_t> equally_spaced(const ContactSweep &sweep, std::int64_t n_samples, bool with_ends);

/// The selected samples of all sweeps, then (complements) those with every status inverted; no contact set
/// twice. with_rest: where the offset is the rest penetration, the selected position nearest to rest is moved
/// there, since small vibration takes place in that contact set alone.
std::vector<SelectedSample> select_samples(const std::vector<ContactSweep> &sweeps, std::int64_t n_samples,
                                           bool with_ends, bool complements, bool with_rest);

} // namespace plm
