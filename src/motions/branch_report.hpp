// A page of text about a curve, for people: what was computed, on what, how good it is, and what to look at.
#pragma once
#include "motions/curve_findings.hpp"
#include "reduction/basis.hpp"

namespace plm {

/// Where its peak has been found.
CurveFindings findings_at(const Peak &peak, const Output &output, const Basis &basis,
                          const Warnings &warnings);

/// Sections of a title and indented lines of at most about 100 characters, with a newline at the end of each.
/// found: null where no peak was looked for.
std::string report_of(const Branch &branch, const CurveFindings *found);

} // namespace plm
