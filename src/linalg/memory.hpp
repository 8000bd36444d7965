// Every array of the library lives in plm::vector, whose allocator asks the context that is active on the
// calling thread (see AllocatorScope). Each block remembers who made it, so it may be freed anywhere.
#pragma once
#include <cstddef>
#include <new>
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

} // namespace plm
