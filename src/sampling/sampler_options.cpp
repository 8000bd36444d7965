#include "sampling/sampler_options.hpp"
#include "linalg/error.hpp"
#include <string>

namespace plm {
namespace {

void demand(bool condition, const char *key, const std::string &text) {
    if (!condition) throw Error(status::argument, text).argument(key);
}

void check_range(double least, double most, const char *key_least, const char *key_most) {
    demand(most == 0 || least < most, key_most,
           format("%s (%g) must be above %s (%g)", key_most, most, key_least, least));
    demand(most > 0 || least == 0, key_most, format("%s is given without %s", key_least, key_most));
}

} // namespace

void check_options(const SamplerOptions &o) {
    check_range(o.search_min_hz, o.search_max_hz, "search_min_hz", "search_max_hz");
    check_range(o.window_min_hz, o.window_max_hz, "window_min_hz", "window_max_hz");
    demand(o.window_max_hz == 0 || o.window_min_hz > 0, "window_min_hz", "window_min_hz must be above 0");
}

} // namespace plm
