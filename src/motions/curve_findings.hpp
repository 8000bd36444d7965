// What searches have found of a curve beside its points, as facts: they are told, handed on and reported
// without the searches themselves.
#pragma once
#include "motions/branch.hpp"
#include <cmath>
#include <optional>

namespace plm {

/// What plm_hbm_find_peak returns.
struct Peak {
    double frequency_hz = 0, amplitude = 0;
    std::shared_ptr<const Branch> branch; // one point
    double basis_error = 0;               // as basis_error_at() tells it
    double harmonic_error = 0;            // what the harmonics leave out; below 0: not known
    bool seen_in_time = false;            // that is by the motion in time (searches/motion_in_time.hpp)
    /// By how much it may be higher than the point found, of that: 0 where it was closed in upon.
    double above = 0;
};

/// A larger motion beside a curve, at the same force (searches/larger_motion.hpp).
struct LargerMotion {
    double frequency_hz = 0, amplitude = 0; // of the highest stable motion
    std::shared_ptr<const Branch> curve;    // that it lies on
    // force scales between which that exists, by the extrema of the backbone; NaN: not known
    double force_low = 0, force_high = 0;
};

/// What the structure comes to in time where the curve has no stable motion.
struct MotionInTime {
    double frequency_hz = 0, amplitude = 0; // largest over a period
};

/// What calls have found of one amplitude of a curve beside its points.
struct CurveFindings {
    Output output;
    Peak peak;
    std::string basis_kind;
    double setup_seconds = 0; // of that basis
    double error = NAN;       // of the peak, relative: the larger of amplitude and frequency; NaN: not known
    double accuracy = 0;      // asked for; 0: by no call
    Warnings warnings;        // of the call that found it
    bool looked_beside = false; // by the one call that does all of it
    std::optional<LargerMotion> larger;
};

} // namespace plm
