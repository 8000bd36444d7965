// Newton's method for R(x, p) = 0 with one linear side condition (a parameter that stays, or the plane across
// a step along a path). Damping is affine-invariant (Deuflhard's natural monotonicity test): the residual
// norm is never the merit, since in modal coordinates it misleads. A factorization is kept as long as it
// contracts fast.
#pragma once
#include "linalg/status.hpp"
#include "paths/metric.hpp"
#include <cmath>

namespace plm {

/// x_weight . (x - x_0) + parameter_weight (p - p_0) = 0, where (x_0, p_0) is the first guess.
struct SideCondition {
    const vector<double> *x_weight = nullptr; // null: zero
    double parameter_weight = 1;
};

struct NewtonLimits {
    double tolerance = 1e-9; // of the last correction, relative to the dynamic part of x
    double aim = INFINITY;   // below the tolerance: to be corrected to that, as far as rounding lets it
    std::int64_t max_iterations = 30;
    double min_damping = 1e-4;  // smaller: give up
    double parameter_scale = 1; // what a change of p is measured by
    bool factored = false;      // the system is factored near the first guess: use it as long as it serves
    const vector<double> *slope = nullptr; // dx/dp along the path where it is factored; null: not known
};

/// What the solutions of equations have cost.
struct NewtonWork {
    std::int64_t iterations = 0, factorizations = 0;
    double seconds = 0; // of the iterations
    NewtonWork &operator+=(const NewtonWork &more);
};

struct NewtonOutcome : NewtonWork {
    bool converged = false;
    std::int32_t reason = reason::none; // why not
    double residual = 0;                // |R| over residual_scale()
    double factored_away = INFINITY;    // how far from the solution the system was factored, as steps count
};

NewtonOutcome newton(Residual &system, const SideCondition &side, const NewtonLimits &limits,
                     vector<double> &x, double &parameter);
/// At a parameter that stays.
NewtonOutcome newton_at(Residual &system, const NewtonLimits &limits, vector<double> &x, double parameter);
/// Within the plane across `direction` through the first guess; the metric gives limits.parameter_scale.
NewtonOutcome newton_across(Residual &system, const Metric &metric, const PathState &direction,
                            NewtonLimits limits, PathState &at);

} // namespace plm
