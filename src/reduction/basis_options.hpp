// Every rule about the basis' options in one place.
#pragma once
#include "reduction/basis.hpp"

namespace plm {

/// Throws PLM_ERR_ARGUMENT with the option's key as argument.
void check_options(const BasisOptions &options);
/// The same for what depends on the model: kinds about contact need a pair, and no more vectors than pairs.
void check_pairs(const BasisOptions &options, std::int64_t n_pairs);

} // namespace plm
