// Taylor coefficients of a harmonic load over a piece of a flow.
#pragma once
#include "contact/contact.hpp"
#include "orbits/flow_piece.hpp"
#include <complex>

namespace plm {

/// A load is Re(F_h z), z = force_scale omega^p exp(i h omega t). The powers of the share of a piece in z:
/// from `begin`, over `duration`, z_0 (i h omega duration)^k / k!.
inline vector<std::complex<double>> load_powers(const LoadPart &part, double omega, double force_scale,
                                                double begin, double duration, std::int64_t count) {
    const double h = part.harmonic;
    vector<std::complex<double>> z(static_cast<std::size_t>(part.harmonic == 0 ? 1 : count));
    z[0] = force_scale * part.growth(omega) * std::polar(1.0, h * omega * begin);
    for (std::size_t k = 1; k < z.size(); ++k)
        z[k] = z[k - 1] * std::complex<double>(0.0, h * omega * duration / static_cast<double>(k));
    return z;
}

/// The same of its derivative by the parameter. By the force scale: z / force_scale. By the frequency: with
/// x = w - (t / omega) x', w' = A w + (t / omega) df/dt + (p / omega) f, so t i h z, whose powers are those
/// of i h z times the begin and, one on, the duration, and what z grows by.
inline vector<std::complex<double>> changed_load_powers(FlowParameter parameter, const LoadPart &part,
                                                        double omega, double force_scale, double begin,
                                                        double duration, std::int64_t count) {
    if (parameter != FlowParameter::frequency) return load_powers(part, omega, 1.0, begin, duration, count);
    vector<std::complex<double>> z = load_powers(part, omega, force_scale, begin, duration, count);
    std::complex<double> before = 0;
    for (std::complex<double> &now : z) {
        const std::complex<double> rate = std::complex<double>(0.0, part.harmonic) * now;
        now = begin * rate + duration * before + part.power / omega * now;
        before = rate;
    }
    return z;
}

/// Adds `factor` times the motion of the walls to the powers of the gaps, Z x terms. powers_of(part): as
/// load_powers(), with no more of them.
template <class Powers>
void add_wall_powers(const Contact &contact, double factor, const Powers &powers_of, Matrix &gaps) {
    for (const auto &[part, moves] : contact.motion) {
        const vector<std::complex<double>> powers = powers_of(part);
        for (std::size_t k = 0; k < powers.size(); ++k)
            for (std::int64_t i = 0; i < gaps.rows(); ++i)
                gaps(i, static_cast<std::int64_t>(k)) +=
                    factor * (powers[k] * Contact::moved(moves, i)).real();
    }
}

} // namespace plm
