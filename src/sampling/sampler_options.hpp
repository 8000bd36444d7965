// Every rule about the sampler's options in one place.
#pragma once
#include "sampling/sampler.hpp"

namespace plm {

/// Throws PLM_ERR_ARGUMENT with the option's key as argument.
void check_options(const SamplerOptions &options);

} // namespace plm
