// Linked into every library that shares its BLAS with the host.
#include "blas_host.hpp"

namespace plm {

void keep_own_blas_to_one_thread() {}

} // namespace plm
