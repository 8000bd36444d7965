// Loads on a structure, harmonic by harmonic.
#pragma once
#include "structure/field.hpp"
#include <map>

namespace plm {

/// Which part of an excitation a load is: of one harmonic, growing with a power of the excitation's frequency
/// omega (rad/s). An unbalance m e omega^2 has the power 2 and the load m e.
struct LoadPart {
    int harmonic = 0, power = 0;
    LoadPart(int h, int p = 0) : harmonic(h), power(p) {}
    bool operator<(const LoadPart &other) const {
        return harmonic != other.harmonic ? harmonic < other.harmonic : power < other.power;
    }
    /// omega^power, and its derivative.
    double growth(double omega) const {
        double g = 1;
        for (int k = 0; k < power; ++k) g *= omega;
        for (int k = 0; k > power; --k) g /= omega;
        return g;
    }
    double growth_rate(double omega) const { return power == 0 ? 0.0 : power * growth(omega) / omega; }
};

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
