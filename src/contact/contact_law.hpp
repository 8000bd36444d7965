// The contact law (paper, eq. (3)): the one place that maps a pair's penetration to its normal force. It is
// piecewise linear, N = k_n u where u > 0 and 0 elsewhere, so its derivative is k_n times the contact
// indicator s = [u > 0]; the solvers integrate s exactly between its switching instants
// (contact_force.hpp). In how many directions a pair acts and which states it has are the law's, too.
#pragma once
#include <cstdint>

namespace plm {

struct ContactLaw {
    /// Directions in which a pair acts, each with its row of the gap matrix: the normal alone.
    static constexpr std::int64_t n_directions = 1;
    /// Of a pair. `switching`: open and closed in turn over a period; no state of an instant.
    enum class State : char { open, closed, switching };
    /// It presses at some time.
    static bool acts(State state) { return state != State::open; }
    /// Its tangent depends on time; where it does not: this share of the stiffness.
    static bool varies(State state) { return state == State::switching; }
    static double constant_share(State state) { return state == State::closed ? 1 : 0; }

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
