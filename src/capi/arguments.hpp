// Checks of arguments, with texts that name the argument, the position and what to do; and text outputs.
#pragma once
#include "linalg/error.hpp"
#include "linalg/memory.hpp"
#include "linalg/scale.hpp"
#include "plm/plm.h"
#include <cmath>

namespace plm::capi {

[[noreturn]] void bad_argument(const char *argument, std::int64_t index, const std::string &text);

void require_pointer(const void *pointer, const char *name);
/// low <= value <= high
void require_range(std::int64_t value, std::int64_t low, std::int64_t high, const char *name);
/// Neither NaN nor infinite nor of a size that overflows in what is computed from it (linalg/scale.hpp).
void require_finite(double value, const char *name);
/// NULL is accepted when n is 0.
void require_finite_array(const double *values, std::int64_t n, const char *name);
void require_index_base(std::int32_t index_base);

/// Text output by the rules of plm.h.
plm_status put_text(const std::string &text, std::int64_t capacity, char *buffer, std::int64_t *needed);

/// Array output: values NULL with capacity 0 asks for the length only.
template <class T>
plm_status put_array(const vector<T> &from, std::int64_t capacity, T *values, std::int64_t *count) {
    const std::int64_t n = static_cast<std::int64_t>(from.size());
    require_pointer(count, "count");
    if (capacity < 0)
        bad_argument("capacity", -1, format("capacity is %lld; it cannot be negative", (long long)capacity));
    if (values || capacity > 0) {
        require_pointer(values, "values");
        if (capacity < n)
            bad_argument("capacity", -1,
                         format("capacity is %lld where %lld values are to be written; ask for the "
                                "length with values = NULL first",
                                (long long)capacity, (long long)n));
        for (std::int64_t i = 0; i < n; ++i) values[i] = from[i];
    }
    *count = n;
    return PLM_OK;
}

/// Output of a complex array in two parts, by the same rules: both or neither.
template <class Complex>
plm_status put_complex_array(const vector<Complex> &from, std::int64_t capacity, double *real, double *imag,
                             std::int64_t *count) {
    if (capacity > 0 || real || imag) {
        require_pointer(real, "real");
        require_pointer(imag, "imag");
    }
    vector<double> parts[2];
    for (const Complex &c : from) {
        parts[0].push_back(c.real());
        parts[1].push_back(c.imag());
    }
    for (const vector<double> &part : parts)
        require_finite_result(part.data(), static_cast<std::int64_t>(part.size()), "real, imag");
    put_array(parts[0], capacity, real, count);
    return put_array(parts[1], capacity, imag, count);
}

} // namespace plm::capi
