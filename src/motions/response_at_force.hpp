// What the equations of a backbone, of harmonic balance or of exact motions, measure their unknowns by.
#pragma once
#include "motions/branch_point.hpp"
#include "motions/options.hpp"

namespace plm {

/// The response at the force asked for, of one at another: a change of omega over the whole range counts as
/// much as it. 1 where nothing moves.
double response_at_force(double response, const BranchPoint &about, const MotionOptions &options);

/// The unit of a frequency among unknowns of this size: so small a change of it counts like the response.
inline double frequency_unit(double size, double omega) {
    constexpr double as_much = 0.05;
    return size / (as_much * omega);
}

} // namespace plm
