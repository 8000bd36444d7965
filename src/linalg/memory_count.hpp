// How much memory a piece of work holds: the arrays of plm::vector made in a scope, and what libraries
// underneath allocate by themselves as far as they tell (CHOLMOD does).
#pragma once
#include "linalg/memory.hpp"
#include <cstdint>

namespace plm {

class MemoryCounter; // lives as long as the scope and the last block counted

/// Counts what this thread allocates during its life, and forwards to the allocator that was active before.
/// Blocks may be released later, on any thread, as with every allocator.
class CountingScope {
  public:
    CountingScope();
    ~CountingScope();
    CountingScope(const CountingScope &) = delete;
    CountingScope &operator=(const CountingScope &) = delete;

    /// Bytes held now, and the most held at once so far, of what was allocated in the scope.
    std::int64_t held() const;
    std::int64_t peak() const;

  private:
    MemoryCounter *counter_, *previous_;
    AllocatorScope allocator_;
};

/// What a library underneath holds for one object, in the count of the scope the object was made in.
class ForeignMemory {
  public:
    ForeignMemory();
    ~ForeignMemory();
    ForeignMemory(const ForeignMemory &) = delete;
    ForeignMemory &operator=(const ForeignMemory &) = delete;
    /// now: bytes held from now on; most: the most held at once since the object was made.
    void holds(std::size_t now, std::size_t most);

  private:
    MemoryCounter *counter_;
    std::int64_t now_ = 0;
};

} // namespace plm
