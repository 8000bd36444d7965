#include "keys.hpp"
#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

namespace scenarios {
namespace {

std::string text_of(std::int32_t kind, std::int32_t index, std::int32_t field) {
    std::int64_t needed = 0;
    plm_key_text(kind, index, field, 0, nullptr, &needed);
    std::string text(static_cast<std::size_t>(needed), '\0');
    plm_key_text(kind, index, field, needed, text.data(), nullptr);
    text.resize(text.find('\0'));
    return text;
}

std::vector<std::string> split(const std::string &list) {
    std::vector<std::string> words;
    for (std::size_t at = 0; at < list.size();) {
        const std::size_t comma = std::min(list.find(',', at), list.size());
        words.push_back(list.substr(at, comma - at));
        at = comma + 1;
    }
    return words;
}

std::vector<Key> listed(std::int32_t kind) {
    std::vector<Key> keys;
    std::int32_t count = 0;
    plm_key_count(kind, &count);
    for (std::int32_t i = 0; i < count; ++i) {
        Key key;
        std::int32_t is_option = 0;
        plm_key_info(kind, i, &key.type, &is_option, &key.low, &key.high);
        key.is_option = is_option != 0;
        key.name = text_of(kind, i, PLM_KEY_NAME);
        key.default_value = text_of(kind, i, PLM_KEY_DEFAULT);
        key.words = split(text_of(kind, i, PLM_KEY_CHOICES));
        key.may_be_nan = kind == PLM_KIND_STUDY; // where a method failed; see plm.h
        keys.push_back(std::move(key));
    }
    return keys;
}

double upper(const Key &key) {
    return key.high > 0 && key.high < 1e60 ? key.high : 1e6;
}

} // namespace

const std::vector<Key> &keys_of(std::int32_t kind) {
    static std::array<std::vector<Key>, PLM_KIND_STUDY + 1> all;
    std::vector<Key> &keys = all[static_cast<std::size_t>(kind)];
    if (keys.empty()) keys = listed(kind);
    return keys;
}

double wild(Random &random) {
    static const std::vector<double> values = {std::numeric_limits<double>::quiet_NaN(),
                                               std::numeric_limits<double>::infinity(),
                                               -1,
                                               0,
                                               1e300,
                                               1e-300,
                                               std::numeric_limits<double>::denorm_min()};
    return random.chance(0.5) ? random.one_of(values) : random.decades(-16, 16);
}

// Mostly near the lower bound, where scenarios are quick; now and then anywhere, or outside.
std::int64_t drawn_int(Random &random, const Key &key) {
    if (random.chance(0.05)) return random.chance(0.5) ? INT64_MAX : INT64_MIN;
    const double low = key.low, high = std::max(low, upper(key));
    if (random.chance(0.7))
        return random.integer(static_cast<std::int64_t>(low),
                              static_cast<std::int64_t>(std::min(high, low + 8)));
    return static_cast<std::int64_t>(low + std::pow(random.real(), 6.0) * (high - low));
}

double drawn_double(Random &random, const Key &key) {
    if (random.chance(0.05)) return wild(random);
    const double usual = std::atof(key.default_value.c_str());
    if (usual > 0 && random.chance(0.6)) return usual * random.decades(-1, 1);
    if (key.name.find("hz") != std::string::npos) return random.decades(-2, 2);
    return key.low > 0 ? key.low * std::pow(upper(key) / key.low, random.real())
                       : upper(key) * random.decades(-12, 0);
}

std::string drawn_word(Random &random, const Key &key) {
    return key.words.empty() || random.chance(0.03) ? "rubbish" : random.one_of(key.words);
}

} // namespace scenarios
