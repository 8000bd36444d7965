// Where a response curve is followed when nobody says otherwise.
#pragma once

namespace plm {

/// The window a basis is made for. Where an end of it is an estimate, a sweep may go on past it, as far as
/// least_hz or most_hz, to have the peak inside; an end that the host gave stays where it is.
struct SweepRange {
    double min_hz = 0, max_hz = 0;    // 0: not known
    double least_hz = 0, most_hz = 0; // 0: as min_hz, max_hz
};

} // namespace plm
