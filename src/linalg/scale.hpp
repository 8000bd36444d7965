// Sizes of numbers that can be squared, multiplied and divided a few times without overflow or loss: what a
// host hands over has to be of such a size, in whatever units.
#pragma once
#include <cmath>
#include <cstdint>

namespace plm {

constexpr double largest_scale = 1e60, smallest_scale = 1e-60;

/// NaN and infinity, too.
inline bool too_large(double v) {
    return !(std::abs(v) <= largest_scale);
}
/// Zero is not.
inline bool too_small(double v) {
    return v != 0 && std::abs(v) < smallest_scale;
}

/// The entry of largest modulus; 0 for none.
inline double largest_of(const double *values, std::int64_t n) {
    double largest = 0;
    for (std::int64_t i = 0; i < n; ++i) largest = std::fmax(largest, std::abs(values[i]));
    return largest;
}

inline bool all_finite(const double *values, std::int64_t n) {
    for (std::int64_t i = 0; i < n; ++i)
        if (!std::isfinite(values[i])) return false;
    return true;
}

/// What to look at where something is not finite.
constexpr const char *sizes_apart =
    "sizes in the model, its loads or the options lie too far apart for double "
    "precision: compare them with those expected";

/// Results: no number that is none leaves the library. Throws with PLM_REASON_NOT_FINITE.
void require_finite_result(const double *values, std::int64_t n, const char *what);

} // namespace plm
