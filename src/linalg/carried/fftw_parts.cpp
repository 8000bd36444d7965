// Parts of our own in the carried FFTW: where malloc fails, its planner and its transforms go on in a
// reserve, since they know no failure: FFTW would print and abort.
#include "linalg/carried/fftw_parts.hpp"
#include "linalg/carried/reserve.hpp"
#include <cstdlib>
#include <new>

namespace {
plm_carried::Reserve<std::size_t(4) << 20> reserve;
}

extern "C" {
void *fftw_kernel_malloc(std::size_t bytes);
void fftw_kernel_free(void *block);
void fftw_assertion_failed(const char *text, int line, const char *file);
}

void *fftw_kernel_malloc(std::size_t bytes) {
    void *block = nullptr;
    return posix_memalign(&block, reserve.alignment, bytes) == 0 ? block : reserve.take(bytes);
}
void fftw_kernel_free(void *block) {
    if (block && !reserve.give_back(block)) std::free(block);
}
/// Not to be reached: carried_fftw_may_work was asked first. FFTW has no way on from here.
void fftw_assertion_failed(const char *, int, const char *) {
    throw std::bad_alloc();
}

bool carried_fftw_may_work(std::size_t bytes) {
    if (reserve.has(bytes)) return true;
    void *probe = std::malloc(bytes);
    std::free(probe);
    return probe != nullptr;
}
