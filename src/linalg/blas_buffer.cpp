#include "blas_host.hpp"
#include "blas_turn.hpp"
#include <atomic>
#include <mutex>
#include <new>
#include <vector>
#ifdef __linux__
#include <sys/mman.h>

// OpenBLAS's own, where the BLAS is one.
extern "C" {
[[gnu::weak]] void *blas_memory_alloc(int);
[[gnu::weak]] void blas_memory_free(void *);
}

namespace plm {
namespace {

constexpr std::size_t buffer_bytes = std::size_t(128) << 20; // OpenBLAS's on x86-64, the largest of all

std::atomic<int> users{0}, reserved{0}; // threads at work in the library, and buffers there are for them
[[gnu::tls_model("initial-exec")]] thread_local int depth = 0; // a callback may call the library again

bool one_more_fits() {
    void *probe = mmap(nullptr, buffer_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return probe != MAP_FAILED && munmap(probe, buffer_bytes) == 0;
}

/// OpenBLAS keeps what it is given back, so that `count` buffers held at once are there from then on.
void reserve(int count) {
    static std::mutex growing;
    const std::lock_guard<std::mutex> lock(growing);
    if (count <= reserved) return;
    const BlasTurn turn;
    std::vector<void *> held;
    held.reserve(static_cast<std::size_t>(count));
    while (static_cast<int>(held.size()) < count && one_more_fits()) held.push_back(blas_memory_alloc(0));
    for (void *buffer : held) blas_memory_free(buffer);
    if (static_cast<int>(held.size()) < count) throw std::bad_alloc();
    reserved = count;
}

} // namespace

BlasBuffer::BlasBuffer() {
    if (!blas_memory_alloc || !blas_memory_free || depth > 0) {
        ++depth;
        return;
    }
    const int count = ++users;
    try {
        if (count > reserved) reserve(count);
    } catch (...) {
        --users;
        throw;
    }
    ++depth;
}
BlasBuffer::~BlasBuffer() {
    if (--depth == 0 && blas_memory_alloc && blas_memory_free) --users;
}

} // namespace plm

#else

namespace plm {
BlasBuffer::BlasBuffer() {}
BlasBuffer::~BlasBuffer() {}
} // namespace plm

#endif
