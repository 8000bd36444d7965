// Polynomials on [0, 1], looked at through their Bernstein coefficients: these enclose the values, so that a
// zero or an extremum can be excluded for certain, and halving the interval converges quadratically. No
// sampling, hence nothing is missed between samples.
#pragma once
#include "linalg/memory.hpp"
#include <cstdint>

namespace plm {

constexpr std::int64_t max_polynomial_degree = 47;

/// p(s) = sum_k coefficient[k] s^k, k = 0 .. degree.
double evaluate_polynomial(const double *coefficient, std::int64_t degree, double s);

/// The first instant s in (0, 1] at which a polynomial with p(0) > 0 is about to fall below -noise: its zero
/// before that, to rounding. Dips that stay above -noise do not count. Returns -1 when there is none.
double first_crossing(const double *coefficient, std::int64_t degree, double noise);

/// Lowers `minimum` and raises `maximum` to the extrema over [0, 1], to rounding; a search that the values
/// given already make idle is saved.
void widen_range(const double *coefficient, std::int64_t degree, double &minimum, double &maximum);

} // namespace plm
