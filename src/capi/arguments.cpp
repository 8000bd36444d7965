#include "capi/arguments.hpp"
#include "linalg/scale.hpp"
#include <algorithm>
#include <cstring>

namespace plm::capi {

using Int = long long; // for printf

void bad_argument(const char *argument, std::int64_t index, const std::string &text) {
    throw Error(PLM_ERR_ARGUMENT, text).argument(argument).index(index);
}

void require_pointer(const void *pointer, const char *name) {
    if (!pointer) bad_argument(name, -1, format("%s is NULL; pass an address", name));
}

void require_range(std::int64_t value, std::int64_t low, std::int64_t high, const char *name) {
    if (value < low || value > high)
        bad_argument(name, -1,
                     format("%s is %lld; it must lie in %lld..%lld", name, Int(value), Int(low), Int(high)));
}

namespace {

std::string overflows(double value) {
    return format(" is %g; beyond %g squares and products overflow: choose units in which it is smaller",
                  value, largest_scale);
}

} // namespace

void require_finite(double value, const char *name) {
    if (!std::isfinite(value)) bad_argument(name, -1, format("%s is NaN or infinite; pass a number", name));
    if (too_large(value)) bad_argument(name, -1, std::string(name) + overflows(value));
}

void require_finite_array(const double *values, std::int64_t n, const char *name) {
    if (n > 0) require_pointer(values, name);
    for (std::int64_t i = 0; i < n; ++i)
        if (!std::isfinite(values[i]))
            bad_argument(name, i, format("%s[%lld] is NaN or infinite; pass numbers only", name, Int(i)));
        else if (too_large(values[i]))
            bad_argument(name, i, format("%s[%lld]", name, Int(i)) + overflows(values[i]));
}

void require_index_base(std::int32_t index_base) {
    if (index_base != 0 && index_base != 1)
        bad_argument("index_base", -1,
                     format("index_base is %d; it must be 0 (C) or 1 (Fortran)", index_base));
}

plm_status put_text(const std::string &text, std::int64_t capacity, char *buffer, std::int64_t *needed) {
    if (capacity < 0)
        bad_argument("capacity", -1, format("capacity is %lld; it cannot be negative", Int(capacity)));
    if (capacity > 0) {
        require_pointer(buffer, "buffer");
        const std::size_t n = std::min(text.size(), static_cast<std::size_t>(capacity - 1));
        std::memcpy(buffer, text.data(), n);
        buffer[n] = '\0';
    }
    if (needed) *needed = static_cast<std::int64_t>(text.size()) + 1;
    return PLM_OK;
}

} // namespace plm::capi
