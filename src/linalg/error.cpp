#include "error.hpp"
#include <cstdarg>
#include <cstdio>

namespace plm {

std::string format(const char *pattern, ...) {
    va_list args, again;
    va_start(args, pattern);
    va_copy(again, args);
    const int length = std::vsnprintf(nullptr, 0, pattern, args);
    va_end(args);
    std::string text;
    if (length > 0) {
        text.resize(static_cast<std::size_t>(length));
        std::vsnprintf(&text[0], text.size() + 1, pattern, again);
    }
    va_end(again);
    return text;
}

} // namespace plm
