// Which harmonic of an excitation drives a resonance.
#pragma once
#include "structure/loads.hpp"

namespace plm {

/// The lowest dynamic harmonic with a load; 0: nothing is driven.
int driven_harmonic(const HarmonicLoads &excitation);

} // namespace plm
