// The linear system that contact is equivalent to in one resonant motion, and the motion itself: harmonic
// balance with a mean and one harmonic, on one mode, by fixed-point iteration (as the updated or iterated
// LELSM modes of AL-Shudeifat and Butcher 2010).
#pragma once
#include "space/space.hpp"

namespace plm {

struct EquivalentMotionOptions {
    double middle = 0;             // rad/s; the mode that responds most at this excitation frequency is taken
    double highest_eigenvalue = 0; // rad^2/s^2: modes looked at
    double amplitude = 0; // > 0: largest amplitude of a pair; 0: of the resonance under the excitation
};

struct EquivalentMotion {
    vector<double> spring;    // Z: equivalent linear stiffness of every pair
    vector<double> coupling;  // Z: the same over k_n, in [0, 1]
    vector<double> mean;      // Z: mean penetration
    vector<double> amplitude; // Z: of the penetration, signed: in phase or in antiphase
    double frequency = 0;     // rad/s, of the mode
    bool settled = false;
    std::int64_t iterations = 0;
};

/// The springs are those of the describing function of every pair's law in u(t) = mean + amplitude cos t. The
/// amplitudes are those of one mode of the system with these springs, at the amplitude asked for or, in
/// resonance, where the damping holds the excitation. The mean is in static equilibrium with the pre-load,
/// the constant excitation and the mean contact forces. Iterated with relaxation until no coupling changes by
/// more than 1e-6 of the largest. Throws PLM_ERR_ARGUMENT when nothing sets an amplitude: no excitation, or
/// no damping.
EquivalentMotion equivalent_motion(const Space &space, const EquivalentMotionOptions &options, Watch watch);

} // namespace plm
