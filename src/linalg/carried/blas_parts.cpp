// What a carried OpenBLAS gets from us. Its kernels for small products, in place of malloc and free: for
// AVX-512 they pack a few rows into a block that they do not check. All of it, a lock around the table of its
// work buffers: a build without threads has none, and gives two threads of the host the same buffer now and
// then. And where it looks for the processor to work for, that one: it knows of no AVX-512 but Intel's.
#include "linalg/carried/reserve.hpp"
#include <cstddef>
#include <cstdlib>
#include <cstring>
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
char *carried_blas_getenv(const char *name);
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

namespace {

// Called when the library is loaded, before any constructor of ours.
bool has_avx512_not_of_intel() {
#if defined(__x86_64__)
    __builtin_cpu_init();
    return !__builtin_cpu_is("intel") && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}
char skylake[] = "SkylakeX"; // getenv() gives what could be written to

} // namespace

// What the user sets goes before.
char *carried_blas_getenv(const char *name) {
    char *value = std::getenv(name);
    return !value && std::strcmp(name, "OPENBLAS_CORETYPE") == 0 && has_avx512_not_of_intel() ? skylake
                                                                                              : value;
}
