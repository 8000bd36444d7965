// Loads on a structure, harmonic by harmonic.
#pragma once
#include "linalg/load_part.hpp"
#include "structure/field.hpp"
#include <map>

namespace plm {

/// Complex amplitude of one part, F(t) = omega^power Re(F exp(i h omega t)), in whatever coordinates;
/// `imag` is empty for h = 0.
struct HarmonicLoad {
    vector<double> real, imag;
};
using HarmonicLoads = std::map<LoadPart, HarmonicLoad>;

/// All parts of one harmonic together, at a frequency; empty where there is none. By how much it changes with
/// the frequency.
HarmonicLoad load_at(const HarmonicLoads &loads, int harmonic, double omega);
HarmonicLoad load_change_at(const HarmonicLoads &loads, int harmonic, double omega);
/// Some part changes with the frequency.
bool grow(const HarmonicLoads &loads);

/// The same on the free DOFs of a structure, one column each.
struct HarmonicForce {
    Field real, imag;
};
using HarmonicForces = std::map<LoadPart, HarmonicForce>;

/// V^T F, empty where there is no load.
vector<double> projected(const Field &v, const Field &load);
HarmonicLoads projected(const Field &v, const HarmonicForces &loads);

/// All that is not zero, side by side behind `none`, which has no columns: of the pre-load and of the
/// excitation.
Field load_columns(const Field &preload, const HarmonicForces &excitation, Field none);

} // namespace plm
