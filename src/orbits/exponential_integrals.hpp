// Integrals of exponentials and of powers times exponentials: Fourier coefficients and mean squares of
// motions that are given piece by piece.
#pragma once
#include "linalg/dense.hpp"
#include <complex>

namespace plm {

/// m_k = integral of s^k exp(rate s) over [0, 1], k = 0 .. degree. end: exp(rate).
void exponential_moments(std::complex<double> rate, std::complex<double> end, std::int64_t degree,
                         vector<std::complex<double>> &m);

/// Integral of exp(rate t) over [0, duration]. end: exp(rate duration).
std::complex<double> exponential_integral(std::complex<double> rate, double duration,
                                          std::complex<double> end);

/// Integrals of cos and sin (omega t) exp(rate (t - begin)) over [begin, begin + duration].
struct HarmonicIntegrals {
    std::complex<double> cosine, sine;
};
HarmonicIntegrals harmonic_integrals(std::complex<double> rate, double omega, double begin, double duration);

} // namespace plm
