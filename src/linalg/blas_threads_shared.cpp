// Linked into every library that shares its BLAS with the host.
#include "blas_host.hpp"

namespace plm {

void keep_own_blas_to_one_thread() {}
const char *own_blas_kernels() {
    return nullptr;
}

} // namespace plm
