// Every array of the library lives in plm::vector, whose allocator asks the context that is active on the
// calling thread (see AllocatorScope). Each block remembers who made it, so it may be freed anywhere.
#pragma once
#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace plm {

/// The host's allocation functions. allocate == null means malloc and free; release == null with an allocate
/// of the host's own means that nothing is to be freed (an arena).
struct Allocator {
    void *(*allocate)(std::size_t bytes, void *user) = nullptr;
    void (*release)(void *block, void *user) = nullptr;
    void *user = nullptr;
};

/// Makes `a` the allocator of this thread for the life of the scope. Null: malloc and free.
/// The functions and `user` of `a` must stay valid until every block made in the scope is released.
class AllocatorScope {
  public:
    explicit AllocatorScope(const Allocator *a);
    ~AllocatorScope();
    AllocatorScope(const AllocatorScope &) = delete;
    AllocatorScope &operator=(const AllocatorScope &) = delete;

  private:
    const Allocator *previous_;
};

/// The allocator of this thread now; null: malloc and free.
const Allocator *active_allocator();

/// Large blocks that are released on this thread in the life of the scope serve it again: fresh pages cost as
/// much as a good part of the work on them. Those of the allocator that is active when the scope begins; all
/// are given back at its end, and before an allocation fails.
class SpareBlocksScope {
  public:
    static constexpr std::size_t least_bytes = std::size_t(1) << 18; // of a block
    static constexpr std::size_t most_bytes = std::size_t(1) << 28;  // of all
    static constexpr int most_blocks = 8;

    SpareBlocksScope();
    ~SpareBlocksScope();
    SpareBlocksScope(const SpareBlocksScope &) = delete;
    SpareBlocksScope &operator=(const SpareBlocksScope &) = delete;

    /// A block of at least so many bytes, hardly more; null: there is none.
    void *take(std::size_t bytes) noexcept;
    /// False: it is not one to keep.
    bool keep(void *block) noexcept;
    void give_back() noexcept;

  private:
    void release_oldest() noexcept;

    SpareBlocksScope *previous_;
    void (*release_)(void *block, void *user); // of the allocator whose blocks are kept
    void *user_;
    void *block_[most_blocks]; // the oldest first
    int count_ = 0;
    std::size_t bytes_ = 0;
};

/// 64-byte aligned block from the active allocator; throws std::bad_alloc.
void *allocate_block(std::size_t bytes);
void release_block(void *block) noexcept;

template <class T> struct ContextAllocator {
    using value_type = T;
    ContextAllocator() = default;
    template <class U> ContextAllocator(const ContextAllocator<U> &) {}
    T *allocate(std::size_t n) {
        if (n > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_alloc();
        return static_cast<T *>(allocate_block(n * sizeof(T)));
    }
    void deallocate(T *p, std::size_t) noexcept { release_block(p); }
    template <class U> bool operator==(const ContextAllocator<U> &) const { return true; }
    template <class U> bool operator!=(const ContextAllocator<U> &) const { return false; }
};

template <class T> using vector = std::vector<T, ContextAllocator<T>>;

/// As ContextAllocator, but entries that are made without a value have none until they get one.
template <class T> struct UnsetAllocator : ContextAllocator<T> {
    UnsetAllocator() = default;
    template <class U> UnsetAllocator(const UnsetAllocator<U> &) {}
    template <class U> struct rebind { using other = UnsetAllocator<U>; };
    template <class U> void construct(U *entry) { ::new (static_cast<void *>(entry)) U; }
    template <class U, class... Value> void construct(U *entry, Value &&...value) {
        ::new (static_cast<void *>(entry)) U(std::forward<Value>(value)...);
    }
};

template <class T> using unset_vector = std::vector<T, UnsetAllocator<T>>;

} // namespace plm
