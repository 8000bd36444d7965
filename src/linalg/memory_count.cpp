#include "linalg/memory_count.hpp"
#include <atomic>
#include <cstdlib>

namespace plm {

class MemoryCounter {
  public:
    MemoryCounter() : below_(active_allocator() ? *active_allocator() : Allocator()) {}

    const Allocator *allocator() const { return &self_; }
    std::int64_t held() const { return held_; }
    std::int64_t peak() const { return peak_; }

    void add(std::int64_t bytes) { see(held_ += bytes); }
    void see(std::int64_t level) {
        std::int64_t highest = peak_;
        while (level > highest && !peak_.compare_exchange_weak(highest, level)) {
        }
    }

    void hold() { ++users_; }
    void let_go() {
        if (--users_ == 0) delete this;
    }

  private:
    // Before each block: its size, in a space that keeps the alignment of malloc.
    static constexpr std::size_t front = alignof(std::max_align_t);
    static_assert(front >= sizeof(std::size_t), "the size of a block stands in its front");

    static void *allocate(std::size_t bytes, void *user) {
        auto *self = static_cast<MemoryCounter *>(user);
        if (bytes > SIZE_MAX - front) return nullptr;
        void *raw = self->below_.allocate ? self->below_.allocate(bytes + front, self->below_.user)
                                          : std::malloc(bytes + front);
        if (!raw) return nullptr;
        *static_cast<std::size_t *>(raw) = bytes;
        self->hold();
        self->add(static_cast<std::int64_t>(bytes));
        return static_cast<char *>(raw) + front;
    }

    static void release(void *block, void *user) {
        auto *self = static_cast<MemoryCounter *>(user);
        void *raw = static_cast<char *>(block) - front;
        self->add(-static_cast<std::int64_t>(*static_cast<std::size_t *>(raw)));
        if (!self->below_.allocate)
            std::free(raw);
        else if (self->below_.release) // without one the host owns an arena
            self->below_.release(raw, self->below_.user);
        self->let_go();
    }

    const Allocator below_; // by value: blocks outlive the scope it came from
    const Allocator self_{allocate, release, this};
    std::atomic<std::int64_t> held_{0}, peak_{0}, users_{1};
};

namespace {
[[gnu::tls_model("initial-exec")]] thread_local MemoryCounter *counting = nullptr; // as in memory.cpp
} // namespace

CountingScope::CountingScope()
    : counter_(new MemoryCounter), previous_(counting), allocator_(counter_->allocator()) {
    counting = counter_;
}
CountingScope::~CountingScope() {
    counting = previous_;
    counter_->let_go(); // allocator_ is restored after this, without a look at the counter
}
std::int64_t CountingScope::held() const {
    return counter_->held();
}
std::int64_t CountingScope::peak() const {
    return counter_->peak();
}

ForeignMemory::ForeignMemory() : counter_(counting) {
    if (counter_) counter_->hold();
}
ForeignMemory::~ForeignMemory() {
    if (!counter_) return;
    counter_->add(-now_);
    counter_->let_go();
}
void ForeignMemory::holds(std::size_t now, std::size_t most) {
    if (!counter_) return;
    const std::int64_t others = counter_->held() - now_;
    counter_->see(others + static_cast<std::int64_t>(most));
    counter_->add(static_cast<std::int64_t>(now) - now_);
    now_ = static_cast<std::int64_t>(now);
}

} // namespace plm
