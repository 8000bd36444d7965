// Static equilibrium under pre-load with unilateral contact: the minimum of a convex, piecewise quadratic
// energy.
#pragma once
#include "space/space.hpp"

namespace plm {

/// The static problem in coordinates where K is diagonal: find the minimum of
/// eta' diag(lambda) eta / 2 - load' eta + sum_i k_i max(u_i, 0)^2 / 2 with u = gap eta less the initial
/// gaps.
struct StaticProblem {
    const vector<double> &lambda; // m, zeros: rigid-body coordinates
    const Matrix &gap;            // Z x m
    const vector<double> &load;   // m
    const Contact &contact;
};

struct StaticState {
    vector<double> coordinates; // eta, m
    vector<double> penetration; // u, Z
    std::int64_t iterations = 0;
};
/// Throws PLM_ERR_CONVERGENCE with PLM_REASON_NO_EQUILIBRIUM when the load drives an unsupported rigid-body
/// motion.
StaticState solve_static(const StaticProblem &problem);

/// The same by whoever solves for the steps: Newton's method, which ends at the minimum from anywhere, for
/// the energy is convex and the search along a step exact.
class RestEquations {
  public:
    virtual ~RestEquations() = default;
    struct Step {
        vector<double> gaps;      // what it does to the penetrations
        double slope, curvature;  // of the energy along it at its begin, without contact
        bool pushes_rigid_motion; // a load drives a motion that neither supports nor contact hold
    };
    /// From the present state, whose penetrations are u.
    virtual Step step(const vector<double> &u) = 0;
    /// Goes this part of the last step.
    virtual void move(double part) = 0;
    /// Of the present state.
    virtual vector<double> penetration() const = 0;
    /// What is summed to B q there, before it cancels.
    virtual vector<double> terms() const = 0;
};
/// Returns the number of steps; u becomes the penetrations. Throws as solve_static().
std::int64_t find_rest(RestEquations &equations, const Contact &contact, vector<double> &u);

/// PLM_ERR_CONVERGENCE with PLM_REASON_NO_EQUILIBRIUM: the load ("pre-load") has nothing to rest on.
/// resultant: what is known of it (Structure::preload_resultant()).
Error no_equilibrium(const char *load, const std::string &resultant = {});

/// The structure at rest under the pre-load, and under the contact forces that are given.
struct RestState {
    vector<double> coordinates; // in the space: q_rest = V coordinates; none where it was found without
    Field displacement;         // one column
    vector<double> penetration; // u = B q - g, per pair
    vector<double> force;       // N per pair
    PairStates states;
    std::int64_t iterations = 0;

    /// force and states, from the penetrations; those of given force have it to the last digit.
    void put_forces(const Model &model);
};
/// Loads, given forces or interference move the structure.
bool is_loaded_at_rest(const Model &model);
/// Solved when first asked for, and kept with the space.
std::shared_ptr<const RestState> rest_of(const Space &space);

} // namespace plm
