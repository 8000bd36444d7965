// Every rule about the basis' options in one place.
#pragma once
#include "reduction/basis.hpp"

namespace plm {

/// Throws PLM_ERR_ARGUMENT with the option's key as argument.
void check_options(const BasisOptions &options);

} // namespace plm
