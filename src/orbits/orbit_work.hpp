// The work against a harmonic load, a Fourier coefficient of the motion, and its derivative by where that
// begins: in closed form in the modes of contact sets that are known.
#pragma once
#include "orbits/contact_modes.hpp"
#include "orbits/monodromy.hpp"

namespace plm {

/// Integral of Re(load exp(i omega t)) . y over the intervals, the motion begun at `state` under the
/// excitation (its frequency and its scale). Its events stay where the intervals have them: to the square of
/// what they move by that is the work of a motion beside the one that they are of. NaN where the modes of a
/// contact set are not usable.
double orbit_work(const FlowModel &model, FlowState state, double excitation, double force_scale,
                  const std::vector<ContactInterval> &intervals, const HarmonicLoad &load, double omega,
                  ContactModesKept &modes);

/// Derivative of that by the state at the beginning (displacements of what moves, velocities of what has
/// mass). Through the instants of the events it does not change: the motion is continuous there. Empty where
/// the modes of a contact set are not usable.
vector<double> work_gradient(const FlowModel &model, const std::vector<ContactInterval> &intervals,
                             const HarmonicLoad &load, double omega, ContactModesKept &modes);

} // namespace plm
