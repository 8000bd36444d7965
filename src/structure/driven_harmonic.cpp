#include "structure/driven_harmonic.hpp"
#include <algorithm>

namespace plm {

int driven_harmonic(const HarmonicLoads &excitation) {
    const auto loaded = [](const vector<double> &f) {
        return std::any_of(f.begin(), f.end(), [](double v) { return v != 0; });
    };
    for (const auto &[part, load] : excitation)
        if (part.harmonic > 0 && (loaded(load.real) || loaded(load.imag))) return part.harmonic;
    return 0;
}

} // namespace plm
