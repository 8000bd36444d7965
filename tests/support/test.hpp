// cmocka for C++ test programs. Work is done in helper functions that return values; assertions stand in the
// test function itself, since a failing assertion jumps over C++ frames.
#pragma once
#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
extern "C" {
#include <cmocka.h>
}
#include <cmath>
#include <cstdio>

/// Fails with the values when |got - want| > tolerance * max(1, |want|); NaN fails.
inline bool near(double got, double want, double tolerance) {
    const double scale = std::abs(want) > 1 ? std::abs(want) : 1;
    const bool ok = std::abs(got - want) <= tolerance * scale;
    if (!ok) std::printf("    got %.17g, want %.17g (tolerance %g)\n", got, want, tolerance);
    return ok;
}
/// The same relative to |want| alone.
inline bool close_to(double got, double want, double relative) {
    const bool ok = std::abs(got - want) <= relative * std::abs(want);
    if (!ok) std::printf("    got %.17g, want %.17g (relative tolerance %g)\n", got, want, relative);
    return ok;
}
/// got <= bound, printed when not.
inline bool below(double got, double bound) {
    const bool ok = got <= bound;
    if (!ok) std::printf("    got %.17g, bound %g\n", got, bound);
    return ok;
}
