// Which part of an excitation something is, be it a load or the motion of a wall.
#pragma once

namespace plm {

/// Of one harmonic, growing with a power of the excitation's frequency omega (rad/s). An unbalance m e
/// omega^2 has the power 2 and the load m e; a displacement of which the velocity is given, the power -1.
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

} // namespace plm
