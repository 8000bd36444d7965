// Linked into a self-contained libplm.so only: the OpenBLAS of this name is the hidden one.
#include "blas_host.hpp"
#include <mutex>

extern "C" {
void openblas_set_num_threads(int);
const char *openblas_get_corename();
}

namespace plm {

void keep_own_blas_to_one_thread() {
    static std::once_flag once;
    std::call_once(once, [] { openblas_set_num_threads(1); });
}

const char *own_blas_kernels() {
    return openblas_get_corename();
}

} // namespace plm
