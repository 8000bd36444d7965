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

} // namespace plm
