// The frequency range where the dominant mode governs the response (paper, 2.3.2).
#pragma once
#include "sampling/sampler.hpp"

namespace plm {

/// Bilinear frequency of two half periods (paper, eq. (6); Shaw and Holmes 1983).
double bilinear_frequency(double f1_hz, double f2_hz);

/// Case A (no pre-load): around the BLF. Case B: around the BLF and the frequency of the system closed as at
/// rest, which by itself can be several per cent off. The half-cycle systems are the two ends of the sweep:
/// pairs with dV > 0 closed, and pairs with dV < 0 closed. A window in the options takes precedence.
FrequencyWindow find_window(const Space &space, const DominantMode &dominant, const ContactSweep &sweep,
                            const RestState &rest, const SamplerOptions &options, Watch watch);

} // namespace plm
