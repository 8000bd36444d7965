// Periodic orbits of the exact flow: Newton's method on the Poincare map with the exact monodromy matrix.
#pragma once
#include "orbits/exact_flow.hpp"

namespace plm {

struct ShootingOptions {
    std::int64_t period_multiple = 1;   // of the excitation's period: 2 after a period doubling
    std::int64_t transient_periods = 0; // marched before Newton's method
    double tolerance = 1e-11;           // of periodicity_defect()
    std::int64_t max_iterations = 30;
    bool march_when_stuck = true; // some periods of marching where no step of Newton's comes closer; they
                                  // lead to a stable orbit, so: false to stay with an unstable one
};

struct PeriodicOrbit {
    FlowState state; // at a time at which the excitation begins a period: the start of the orbit
    std::int64_t period_multiple = 1;
    bool converged = false;
    std::int64_t iterations = 0;
    double defect = 0;                            // as periodicity_defect()
    vector<std::complex<double>> multipliers;     // over period_multiple periods, largest modulus first
    std::vector<ContactInterval> contact_history; // of the orbit, from its start
};

/// From `start`, at any time. Not converged: the best state found, with its defect. Throws what
/// ExactFlow::advance() throws.
PeriodicOrbit periodic_orbit(ExactFlow &flow, const FlowState &start, const ShootingOptions &options = {});

/// |state after period_multiple periods - state| relative to the largest distance of the motion from its
/// start, both in the energy norm |y, v|^2 = sum (lambda + omega^2) y^2 + v^2 (omega^2: for rigid-body
/// motion). 0 for a structure that stays at rest. The one number that any solution of harmonic balance can be
/// asked for.
double periodicity_defect(ExactFlow &flow, const FlowState &state, std::int64_t period_multiple = 1);

} // namespace plm
