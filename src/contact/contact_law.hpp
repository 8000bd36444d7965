// The contact law (paper, eq. (3)): the one place that maps a pair's penetration to its normal force. It is
// piecewise linear, N = k_n u where u > 0 and 0 elsewhere, so its derivative is k_n times the contact
// indicator s = [u > 0]; the solvers integrate s exactly between its switching instants
// (contact_force.hpp).
#pragma once

namespace plm {

struct ContactLaw {
    static bool closed(double penetration) { return penetration > 0; }
    static double force(double stiffness, double penetration) {
        return closed(penetration) ? stiffness * penetration : 0.0;
    }
    static double tangent(double stiffness, double penetration) {
        return closed(penetration) ? stiffness : 0.0;
    }
    /// Potential energy, convex: used by the static equilibrium.
    static double energy(double stiffness, double penetration) {
        return closed(penetration) ? 0.5 * stiffness * penetration * penetration : 0.0;
    }
};

} // namespace plm
