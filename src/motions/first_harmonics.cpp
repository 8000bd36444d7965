#include "motions/first_harmonics.hpp"
#include <algorithm>

namespace plm {
namespace {

constexpr std::int64_t first_harmonics = 5;

bool loaded(const HarmonicLoad &load) {
    const auto acts = [](double f) { return f != 0; };
    return std::any_of(load.real.begin(), load.real.end(), acts) ||
           std::any_of(load.imag.begin(), load.imag.end(), acts);
}

} // namespace

std::int64_t highest_excitation(const ReducedModel &m) {
    int highest = std::max(1, m.whole_contact().highest_motion());
    for (const auto &[part, load] : m.excitation)
        if (loaded(load)) highest = std::max(highest, part.harmonic);
    return highest;
}

std::int64_t few_harmonics(const ReducedModel &reduced) {
    return std::max(first_harmonics, highest_excitation(reduced));
}

} // namespace plm
