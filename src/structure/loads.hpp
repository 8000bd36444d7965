// Loads on a structure, harmonic by harmonic.
#pragma once
#include "structure/field.hpp"
#include <map>

namespace plm {

/// Complex amplitude of one excitation harmonic, F(t) = Re(F exp(i h omega t)), in whatever coordinates;
/// `imag` is empty for h = 0.
struct HarmonicLoad {
    vector<double> real, imag;
};
using HarmonicLoads = std::map<int, HarmonicLoad>; // by harmonic

/// The same on the free DOFs of a structure, one column each.
struct HarmonicForce {
    Field real, imag;
};

/// V^T F, empty where there is no load.
vector<double> projected(const Field &v, const Field &load);
HarmonicLoads projected(const Field &v, const std::map<int, HarmonicForce> &loads);

/// All that is not zero, side by side: of the pre-load and of the excitation.
Field load_columns(const Field &preload, const std::map<int, HarmonicForce> &excitation, std::int64_t n_free);

} // namespace plm
