// What a carried OpenBLAS gets from us. Its kernels for small products, in place of malloc and free: for
// AVX-512 they pack a few rows into a block that they do not check. All of it, a lock around the table of its
// work buffers: a build without threads has none, and gives two threads of the host the same buffer now and
// then.
#include "linalg/carried/reserve.hpp"
#include <cstddef>
#include <cstdlib>
#include <mutex>
#include <sched.h>

namespace {
// Products of up to 1e6 multiplications come here; what one packs of them is below 8 MB.
plm_carried::Reserve<std::size_t(8) << 20> reserve;
std::mutex buffers;
} // namespace

extern "C" {
void *carried_blas_malloc(std::size_t bytes);
void carried_blas_free(void *block);
int carried_blas_has_lock();
// By the linker's --wrap: every call of blas_memory_alloc comes to the first, the second is OpenBLAS's own.
void *__wrap_blas_memory_alloc(int level); // NOLINT: the linker makes the names
void *__real_blas_memory_alloc(int level); // NOLINT
}

void *__wrap_blas_memory_alloc(int level) { // NOLINT
    const std::lock_guard<std::mutex> lock(buffers);
    return __real_blas_memory_alloc(level);
}

int carried_blas_has_lock() {
    return 1;
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
