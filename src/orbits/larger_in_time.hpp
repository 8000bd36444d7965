// What the structure does where a curve of exact motions is not stable, but beside its folds: time marching
// tells.
#pragma once
#include "linalg/monitor.hpp"
#include "motions/curve_findings.hpp"
#include <optional>
#include <string>

namespace plm {

/// The largest amplitude that the structure comes to from some unstable motions of the curve on, disturbed a
/// little, where that is more than its peak (by the accuracy); none of measures other than peak and half peak
/// to peak.
std::optional<MotionInTime> find_larger_in_time(const Branch &curve, const Output &of, double peak,
                                                double accuracy, Watch watch);

/// What is said of it.
std::string words_for(const MotionInTime &larger, double peak);

} // namespace plm
