// What the kernels for small products of a carried OpenBLAS get in place of malloc and free: for AVX-512 they
// pack a few rows into a block that they do not check.
#include "linalg/carried/reserve.hpp"
#include <cstdlib>
#include <sched.h>

namespace {
// Products of up to 1e6 multiplications come here; what one packs of them is below 8 MB.
plm_carried::Reserve<std::size_t(8) << 20> reserve;
} // namespace

extern "C" {
void *carried_blas_malloc(std::size_t bytes);
void carried_blas_free(void *block);
}

void *carried_blas_malloc(std::size_t bytes) {
    void *block = std::malloc(bytes);
    while (!block && !(block = reserve.take(bytes)))
        sched_yield(); // another thread is about to give its block back
    return block;
}
void carried_blas_free(void *block) {
    if (block && !reserve.give_back(block)) std::free(block);
}
