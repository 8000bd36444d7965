#include "orbits/exponential_integrals.hpp"
#include <cmath>

namespace plm {

namespace {

using Complex = std::complex<double>;

// The standard's quotient looks after squares that vanish or overflow, at several times the price.
Complex quotient(Complex a, Complex b) {
    const double share = 1 / std::norm(b);
    return {(a.real() * b.real() + a.imag() * b.imag()) * share,
            (a.imag() * b.real() - a.real() * b.imag()) * share};
}

} // namespace

// By parts, m_k = (exp(rate) - k m_(k-1)) / rate: forward as long as k < |rate|, from beyond the degree
// backward for the rest, so that errors shrink.
void exponential_moments(Complex rate, Complex end, std::int64_t degree, vector<Complex> &m) {
    constexpr double forgotten = 1e-18; // what is left of the guess at the far end
    const double a = std::abs(rate), real = end.real(), imag = end.imag();
    const bool only_forward = a > static_cast<double>(degree) && a > 1;
    const std::int64_t turn = only_forward ? degree + 1 : static_cast<std::int64_t>(a);
    m.resize(static_cast<std::size_t>(degree + 1));
    double re = 0, im = 0;
    const Complex inverse = turn > 0 ? quotient(1.0, rate) : Complex();
    for (std::int64_t k = 0; k < turn; ++k) {
        const double x = real - (k > 0 ? static_cast<double>(k) * re : 1.0),
                     y = imag - static_cast<double>(k) * im;
        re = x * inverse.real() - y * inverse.imag(), im = x * inverse.imag() + y * inverse.real();
        m[static_cast<std::size_t>(k)] = {re, im};
    }
    if (turn > degree) return;
    std::int64_t far = degree;
    for (double guess = 1; guess > forgotten || far == degree;) guess *= a / static_cast<double>(++far);
    re = real / static_cast<double>(far + 1), im = imag / static_cast<double>(far + 1);
    for (std::int64_t k = far;; --k) { // m_(k-1) = (exp(rate) - rate m_k) / k
        if (k <= degree) m[static_cast<std::size_t>(k)] = {re, im};
        if (k == turn) return;
        const double share = 1 / static_cast<double>(k),
                     x = (real - rate.real() * re + rate.imag() * im) * share;
        im = (imag - rate.real() * im - rate.imag() * re) * share;
        re = x;
    }
}

Complex exponential_integral(Complex rate, double duration, Complex end) {
    constexpr double slow = 0.03; // below, the difference of the exponentials loses digits
    constexpr int terms = 8;      // slow^8 / 9! is nothing
    const Complex x = rate * duration;
    if (std::norm(x) > slow * slow) return duration * quotient(end - 1.0, x);
    Complex sum = 1;
    for (int k = terms; k > 1; --k) sum = 1.0 + sum * x / static_cast<double>(k);
    return duration * sum;
}

HarmonicIntegrals harmonic_integrals(Complex rate, double omega, double begin, double duration) {
    const Complex turn(0, omega), up = rate + turn, down = rate - turn;
    const Complex ahead = std::polar(1.0, omega * begin) *
                          exponential_integral(up, duration, std::exp(up * duration)),
                  back = std::polar(1.0, -omega * begin) *
                         exponential_integral(down, duration, std::exp(down * duration));
    return {0.5 * (ahead + back), Complex(0, -0.5) * (ahead - back)};
}

} // namespace plm
