// Memory for carried code that knows no failing malloc.
#pragma once
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace plm_carried {

/// Blocks from the front of a static array, which costs nothing as long as malloc serves; free again when
/// none is left.
template <std::size_t size> class Reserve {
  public:
    void *take(std::size_t bytes) {
        const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
        const std::lock_guard<std::mutex> lock(mutex_);
        if (rounded < bytes || rounded > size - used_) return nullptr;
        char *block = room_ + used_;
        used_ += rounded;
        ++live_;
        return block;
    }
    /// False: not a block of the reserve.
    bool give_back(void *pointer) {
        const auto first = reinterpret_cast<std::uintptr_t>(room_),
                   p = reinterpret_cast<std::uintptr_t>(pointer);
        if (p < first || p >= first + size) return false;
        const std::lock_guard<std::mutex> lock(mutex_);
        if (--live_ == 0) used_ = 0;
        return true;
    }
    bool has(std::size_t bytes) {
        const std::lock_guard<std::mutex> lock(mutex_);
        return bytes <= size - used_;
    }
    static constexpr std::size_t alignment = 64;

  private:
    std::mutex mutex_;
    std::size_t used_ = 0, live_ = 0;
    alignas(alignment) char room_[size] = {};
};

} // namespace plm_carried
