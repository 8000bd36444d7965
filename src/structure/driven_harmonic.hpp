// Which harmonic of an excitation drives a resonance.
#pragma once
#include "structure/loads.hpp"

namespace plm {

/// The lowest dynamic harmonic with a load; null: nothing is driven.
const std::pair<const int, HarmonicLoad> *driven_harmonic(const HarmonicLoads &excitation);

} // namespace plm
