// Private to structure/solver: hashes of indices.
#pragma once
#include <cstdint>

namespace plm {

/// A good 64-bit hash of an index (the finalizer of SplitMix64).
inline std::uint64_t mixed(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

} // namespace plm
