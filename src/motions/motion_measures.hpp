// Mean energies over a period of a motion, and how much of the contact is closed.
#pragma once
#include "motions/branch.hpp"

namespace plm {

struct MotionMeasures {
    double kinetic = 0, strain = 0, contact = 0, load = 0; // load: potential of the pre-load, -P . q
    double total = 0;        // the sum, less that of the structure at rest under the pre-load
    double closed_share = 0; // mean over the period and the pairs, 0 to 1; 0 without pairs
};
MotionMeasures measure_motion(const ReducedModel &reduced, const BranchPoint &point,
                              std::int64_t period_multiple = 1);

/// The amplitude of the motion that contact or stiffness holds (a point's dynamic part in the norm of M):
/// what a curve's highest point is judged by where no DOF is named.
double response_size(const Branch &branch, std::int64_t point);
std::int64_t largest_response(const Branch &branch);

/// The DOF that moves most at a point: what a curve is judged by where none is named.
Output most_moving(const Branch &branch, std::int64_t point);

/// Up to `wanted` points spread over a curve by their number, which its curvature sets.
vector<std::int64_t> spread_over(const Branch &branch, std::int64_t wanted);

/// Re(F^H q) in the excitation's lowest dynamic harmonic; zero at phase resonance, positive below and
/// negative above a resonance. Does not depend on the force scale.
double phase_of(const ReducedModel &reduced, const BranchPoint &point, std::int64_t period_multiple);

} // namespace plm
