#include "memory.hpp"
#include <cstdint>
#include <cstdlib>
#include <new>
#if defined(__linux__)
#include <cerrno>
#include <sys/mman.h>
#endif

namespace plm {
namespace {

constexpr std::size_t alignment = 64; // a cache line, and enough for every vector unit

// initial-exec: the other model asks malloc for each new thread in a library that was loaded by dlopen, and
// the loader ends the process where it gets none.
[[gnu::tls_model("initial-exec")]] thread_local const Allocator *active = nullptr;

/// Stands directly before each block. The allocator is kept by value, so that a block may outlive the scope
/// (and the Allocator object) it was made in and may be freed on any thread.
struct Header {
    void (*release)(void *block, void *user);
    void *user;
    void *raw;
};

/// Large blocks are asked for in large pages, which the system clears and finds faster; where it has none, or
/// is set not to, nothing happens.
void ask_for_large_pages([[maybe_unused]] void *raw, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
    constexpr std::size_t large = std::size_t(1) << 24, page = std::size_t(1) << 21;
    if (bytes < large) return;
    const auto begin = (reinterpret_cast<std::uintptr_t>(raw) + page - 1) / page * page,
               end = (reinterpret_cast<std::uintptr_t>(raw) + bytes) / page * page;
    const int before = errno; // the host's
    madvise(reinterpret_cast<void *>(begin), end - begin, MADV_HUGEPAGE);
    errno = before;
#endif
}

} // namespace

AllocatorScope::AllocatorScope(const Allocator *a) : previous_(active) {
    active = a;
}
AllocatorScope::~AllocatorScope() {
    active = previous_;
}

const Allocator *active_allocator() {
    return active;
}

void *allocate_block(std::size_t bytes) {
    constexpr std::size_t overhead = sizeof(Header) + alignment;
    if (bytes > SIZE_MAX - overhead) throw std::bad_alloc();
    const bool hosts = active && active->allocate;
    void *raw = hosts ? active->allocate(bytes + overhead, active->user) : std::malloc(bytes + overhead);
    if (!raw) throw std::bad_alloc();
    if (!hosts) ask_for_large_pages(raw, bytes + overhead);
    const auto first = reinterpret_cast<std::uintptr_t>(raw) + sizeof(Header);
    const auto aligned = (first + alignment - 1) / alignment * alignment;
    auto *header = reinterpret_cast<Header *>(aligned) - 1;
    // A host that allocates but gives no release function owns an arena: nothing is to be freed.
    *header = hosts ? Header{active->release, active->user, raw}
                    : Header{[](void *block, void *) { std::free(block); }, nullptr, raw};
    return reinterpret_cast<void *>(aligned);
}

void release_block(void *block) noexcept {
    if (!block) return;
    const Header header = static_cast<Header *>(block)[-1];
    if (header.release) header.release(header.raw, header.user);
}

} // namespace plm
