// A page of text about a curve, for people: what was computed, on what, how good it is, and what to look at.
#pragma once
#include "searches/larger_motion.hpp"
#include <cmath>

namespace plm {

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

/// Where its peak has been found.
CurveFindings findings_at(const Peak &peak, const Output &output, const Basis &basis,
                          const Warnings &warnings);

/// Sections of a title and indented lines of at most about 100 characters, with a newline at the end of each.
/// found: null where no peak was looked for.
std::string report_of(const Branch &branch, const CurveFindings *found);

} // namespace plm
