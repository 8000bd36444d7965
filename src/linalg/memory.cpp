#include "memory.hpp"
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace plm {
namespace {

constexpr std::size_t alignment = 64; // a cache line, and enough for every vector unit

// initial-exec: the other model asks malloc for each new thread in a library that was loaded by dlopen, and
// the loader ends the process where it gets none.
[[gnu::tls_model("initial-exec")]] thread_local const Allocator *active = nullptr;

[[gnu::tls_model("initial-exec")]] thread_local SpareBlocksScope *spare = nullptr;

/// Stands directly before each block. The allocator is kept by value, so that a block may outlive the scope
/// (and the Allocator object) it was made in and may be freed on any thread.
struct Header {
    void (*release)(void *block, void *user);
    void *user;
    void *raw;
    std::size_t bytes;
};

Header &header_of(void *block) {
    return static_cast<Header *>(block)[-1];
}

void release_raw(const Header &header) {
    if (header.release) header.release(header.raw, header.user);
}

void release_to_malloc(void *block, void *) {
    std::free(block);
}

/// Who releases what is allocated now. A host that allocates but gives no release function owns an arena:
/// nothing is to be freed.
Header maker() {
    if (active && active->allocate) return {active->release, active->user, nullptr, 0};
    return {release_to_malloc, nullptr, nullptr, 0};
}

void *allocate_raw(std::size_t bytes) {
    return active && active->allocate ? active->allocate(bytes, active->user) : std::malloc(bytes);
}

#ifdef __SANITIZE_ADDRESS__ // which is to see each block released
constexpr bool keeps_spare = false;
#else
constexpr bool keeps_spare = true;
#endif

} // namespace

SpareBlocksScope::SpareBlocksScope() : previous_(spare), release_(maker().release), user_(maker().user) {
    spare = this;
}

SpareBlocksScope::~SpareBlocksScope() {
    give_back();
    spare = previous_;
}

void *SpareBlocksScope::take(std::size_t bytes) noexcept {
    if (bytes < least_bytes || maker().release != release_ || maker().user != user_) return nullptr;
    int best = -1;
    for (int i = 0; i < count_; ++i) {
        const std::size_t has = header_of(block_[i]).bytes;
        if (has >= bytes && has - bytes <= bytes / 2 && (best < 0 || has < header_of(block_[best]).bytes))
            best = i;
    }
    if (best < 0) return nullptr;
    void *block = block_[best];
    bytes_ -= header_of(block).bytes;
    std::copy(block_ + best + 1, block_ + count_, block_ + best);
    --count_;
    return block;
}

bool SpareBlocksScope::keep(void *block) noexcept {
    const Header &header = header_of(block);
    if (!keeps_spare || !header.release || header.release != release_ || header.user != user_) return false;
    if (header.bytes < least_bytes || header.bytes > most_bytes) return false;
    while (count_ == most_blocks || bytes_ + header.bytes > most_bytes) release_oldest();
    block_[count_++] = block;
    bytes_ += header.bytes;
    return true;
}

void SpareBlocksScope::release_oldest() noexcept {
    const Header header = header_of(block_[0]);
    bytes_ -= header.bytes;
    std::copy(block_ + 1, block_ + count_, block_);
    --count_;
    release_raw(header);
}

void SpareBlocksScope::give_back() noexcept {
    while (count_ > 0) release_oldest();
}

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
    if (spare)
        if (void *block = spare->take(bytes)) return block;
    void *raw = allocate_raw(bytes + overhead);
    if (!raw && spare) {
        spare->give_back();
        raw = allocate_raw(bytes + overhead);
    }
    if (!raw) throw std::bad_alloc();
    const auto first = reinterpret_cast<std::uintptr_t>(raw) + sizeof(Header);
    const auto aligned = (first + alignment - 1) / alignment * alignment;
    void *block = reinterpret_cast<void *>(aligned);
    header_of(block) = maker();
    header_of(block).raw = raw;
    header_of(block).bytes = bytes;
    return block;
}

void release_block(void *block) noexcept {
    if (!block || (spare && spare->keep(block))) return;
    release_raw(header_of(block));
}

} // namespace plm
