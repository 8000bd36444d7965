#include "sampling/sampler_options.hpp"
#include "linalg/error.hpp"
#include <cmath>
#include <string>

namespace plm {
namespace {

void demand(bool condition, const char *key, const std::string &text) {
    if (!condition) throw Error(PLM_ERR_ARGUMENT, text).argument(key);
}

void demand_frequency(double hz, const char *key) {
    demand(std::isfinite(hz) && hz >= 0, key,
           format("%s is %g; a frequency in Hz, or 0 for none, is wanted", key, hz));
}

void check_range(double least, double most, const char *key_least, const char *key_most) {
    demand_frequency(least, key_least);
    demand_frequency(most, key_most);
    demand(most == 0 || least < most, key_most,
           format("%s (%g) must be above %s (%g)", key_most, most, key_least, least));
    demand(most > 0 || least == 0, key_most, format("%s is given without %s", key_least, key_most));
}

} // namespace

void check_options(const SamplerOptions &o) {
    demand(o.mode >= 0, "mode",
           format("mode is %lld; modes are counted from 1, 0 leaves the choice to the sampler",
                  static_cast<long long>(o.mode)));
    demand_frequency(o.mode_frequency_hz, "mode_frequency_hz");
    check_range(o.search_min_hz, o.search_max_hz, "search_min_hz", "search_max_hz");
    demand(o.n_samples >= 1, "n_samples",
           format("n_samples is %lld; at least 1 is needed", static_cast<long long>(o.n_samples)));
    demand(
        o.window_half_width > 0 && o.window_half_width < 1, "window_half_width",
        format("window_half_width is %g; a share of the frequency in (0, 1) is wanted", o.window_half_width));
    check_range(o.window_min_hz, o.window_max_hz, "window_min_hz", "window_max_hz");
    demand(o.window_max_hz == 0 || o.window_min_hz > 0, "window_min_hz", "window_min_hz must be above 0");
    demand(o.n_harmonics >= 1, "n_harmonics",
           format("n_harmonics is %lld; at least 1 is needed", static_cast<long long>(o.n_harmonics)));
    for (std::size_t i = 0; i < o.extra.size(); ++i) {
        if (o.extra[i].mode >= 1 && o.extra[i].system != LinearSystem::automatic) continue;
        throw Error(
            PLM_ERR_ARGUMENT,
            format(
                "further dominant mode %lld: an open or sliding system and a mode counted from 1 are wanted",
                static_cast<long long>(i)))
            .argument("mode")
            .index(static_cast<std::int64_t>(i));
    }
}

} // namespace plm
