// Where a path stands, with all that its next steps are made from: a path that goes on from here takes the
// same steps, to the last bit, as one that was never stopped, since both begin anew with no more than this.
#pragma once
#include "paths/metric.hpp"

namespace plm {

struct PathProgress {
    PathState at;           // the last point
    PathState direction;    // unit tangent there, in the direction travelled
    double orientation = 1; // sign of det(dR/dx) times that of direction.parameter
    double scale = 0, arclength = 0;
    double step = 0;          // to be tried next
    double last_step = 0;     // that led here; 0: nothing is known of how the path bends
    PathState last_direction; // where that began
    bool plain_predictor = false, rescued = false;
    std::int64_t n_recorded = 0, n_rescues = 0, failed_steps = 0;
    vector<double> tests; // at the last point
    // where the path is closed, and what it has passed (PassedPoints::numbers())
    PathState target, target_direction;
    bool closes_at_start = true;
    vector<double> passed;
};

} // namespace plm
