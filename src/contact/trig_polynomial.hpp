// Real trigonometric polynomials x(t) = a0 + sum_h a_h cos h t + b_h sin h t, t in radian over one period 2
// pi. Coefficients in the order a0, a1, b1, ..., aH, bH.
#pragma once
#include "linalg/dense.hpp"
#include <cstddef>

namespace plm {

struct TrigValue {
    double value, slope, curvature, third;
};
/// x, x', x'', x''' at t by one recurrence.
TrigValue evaluate_trig(const double *coefficient, std::int64_t n_harmonics, double t);

/// Cosines and sines, in the order of the coefficients, at the n instants 2 pi i / n: n x (2H + 1).
Matrix trig_grid(std::int64_t n_harmonics, std::int64_t n);

struct ValueRange {
    double minimum, maximum;
};
/// Exact extrema over the period.
ValueRange trig_range(const double *coefficient, std::int64_t n_harmonics);

/// One end of a bracket: the instant, and x and x' there.
struct TrigEnd {
    double t, value, slope;
};
/// An instant with its cosine and sine.
struct TrigInstant {
    double t, cosine, sine;
};
/// A zero of x between two ends where x changes sign; converged to rounding.
TrigInstant trig_root(const double *coefficient, std::int64_t n_harmonics, TrigEnd low, TrigEnd high);
/// A zero of x' between two ends where x' changes sign.
double trig_stationary(const double *coefficient, std::int64_t n_harmonics, TrigEnd low, TrigEnd high);

} // namespace plm
