// The work against a harmonic load, a Fourier coefficient of the motion, as a function of where it begins.
#pragma once
#include "orbits/contact_modes.hpp"
#include "orbits/monodromy.hpp"

namespace plm {

/// Derivative of the integral of Re(load exp(i omega t)) . y over the intervals by the state at their
/// beginning (displacements of what moves, velocities of what has mass). Through the instants of the events
/// it does not change: the motion is continuous there. Empty where the modes of a contact set are not usable.
vector<double> work_gradient(const FlowModel &model, const std::vector<ContactInterval> &intervals,
                             const HarmonicLoad &load, double omega, ContactModesKept &modes);

} // namespace plm
