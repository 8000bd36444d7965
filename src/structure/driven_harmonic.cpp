#include "structure/driven_harmonic.hpp"
#include <algorithm>

namespace plm {

const std::pair<const int, HarmonicLoad> *driven_harmonic(const HarmonicLoads &excitation) {
    const auto loaded = [](const vector<double> &f) {
        return std::any_of(f.begin(), f.end(), [](double v) { return v != 0; });
    };
    for (const auto &entry : excitation)
        if (entry.first > 0 && (loaded(entry.second.real) || loaded(entry.second.imag))) return &entry;
    return nullptr;
}

} // namespace plm
