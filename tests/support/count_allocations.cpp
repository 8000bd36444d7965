#include "count_allocations.hpp"
#include <cstdlib>
#include <new>

namespace {

thread_local long n_allocations = 0;

void *counted(std::size_t bytes) {
    ++n_allocations;
    return std::malloc(bytes > 0 ? bytes : 1);
}

} // namespace

void *operator new(std::size_t bytes) {
    if (void *block = counted(bytes)) return block;
    throw std::bad_alloc();
}
void operator delete(void *block) noexcept {
    std::free(block);
}
void operator delete(void *block, std::size_t) noexcept {
    std::free(block);
}

namespace test {

AllocationCount::AllocationCount()
    : before_(n_allocations), counting_{[](std::size_t bytes, void *) { return counted(bytes); },
                                        [](void *block, void *) { std::free(block); }, nullptr},
      scope_(&counting_) {}

long AllocationCount::so_far() const {
    return n_allocations - before_;
}

} // namespace test
