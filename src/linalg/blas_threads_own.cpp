// Linked into a self-contained libplm.so only: the OpenBLAS of this name is the hidden one.
#include "blas_host.hpp"
#include <mutex>

extern "C" void openblas_set_num_threads(int);

namespace plm {

void keep_own_blas_to_one_thread() {
    static std::once_flag once;
    std::call_once(once, [] { openblas_set_num_threads(1); });
}

} // namespace plm
