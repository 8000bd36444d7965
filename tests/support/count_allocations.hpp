// How often this thread allocates: arrays of the library (plm::vector) and whatever else comes from the
// global operator new, which a program that links count_allocations.cpp has replaced.
#pragma once
#include "linalg/memory.hpp"

namespace test {

/// Counts while it lives.
class AllocationCount {
  public:
    AllocationCount();
    long so_far() const;

  private:
    long before_;
    plm::Allocator counting_;
    plm::AllocatorScope scope_;
};

} // namespace test
