// Newton's method for R(x, omega) = 0 with one linear side condition (fixed frequency, or the hyperplane of a
// continuation step). Damping is affine-invariant (Deuflhard's natural monotonicity test): the residual norm
// is never the merit, since in modal coordinates it misleads. A factorization is kept as long as it contracts
// fast.
#pragma once
#include "hbm/system.hpp"

namespace plm {

/// x_weight . (x - x_0) + omega_weight (omega - omega_0) = 0, where (x_0, omega_0) is the first guess.
struct SideCondition {
    const vector<double> *x_weight = nullptr; // null: zero
    double omega_weight = 1;
};

struct NewtonLimits {
    double tolerance = 1e-9; // of the last correction, relative to the dynamic part of x
    std::int64_t max_iterations = 30;
    double min_damping = 1e-4; // smaller: give up
    double omega_scale = 1;    // what a change of omega is measured by
    bool factored = false;     // the system is factored near the first guess: use it as long as it serves
};

struct NewtonOutcome {
    bool converged = false;
    std::int32_t reason = PLM_REASON_NONE; // why not
    std::int64_t iterations = 0, factorizations = 0;
    double seconds = 0;         // of the iterations
    double residual = 0;        // |R| over residual_scale()
    bool factored_here = false; // the system's factorization belongs to (nearly) the solution
};

NewtonOutcome newton(HbmSystem &system, const SideCondition &side, const NewtonLimits &limits,
                     vector<double> &x, double &omega);

} // namespace plm
