// Numbers of one scenario: everything in it follows from its seed.
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

namespace scenarios {

/// splitmix64 (Steele, Lea and Flood 2014): any seed will do, neighbours too.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits() {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }
    /// 0 <= x < 1
    double real() { return std::ldexp(static_cast<double>(bits() >> 11), -53); }
    /// -1 <= x < 1
    double both_signs() { return 2 * real() - 1; }
    double between(double low, double high) { return low + (high - low) * real(); }
    /// 10^low ... 10^high, each decade as often
    double decades(double low, double high) { return std::pow(10.0, between(low, high)); }
    /// low <= i <= high
    std::int64_t integer(std::int64_t low, std::int64_t high) {
        return low + static_cast<std::int64_t>(bits() % static_cast<std::uint64_t>(high - low + 1));
    }
    bool chance(double share) { return real() < share; }
    template <class T> const T &one_of(const std::vector<T> &all) {
        return all[static_cast<std::size_t>(integer(0, static_cast<std::int64_t>(all.size()) - 1))];
    }

  private:
    std::uint64_t state_;
};

} // namespace scenarios
