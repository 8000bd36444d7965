#include "contact/trig_polynomial.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

TrigValue evaluate_trig(const double *x, std::int64_t n_harmonics, double t) {
    const double c1 = std::cos(t), s1 = std::sin(t);
    double c = 1, s = 0;
    TrigValue v{x[0], 0, 0};
    for (std::int64_t h = 1; h <= n_harmonics; ++h) {
        const double next = c * c1 - s * s1;
        s = s * c1 + c * s1;
        c = next;
        const double a = x[2 * h - 1], b = x[2 * h], k = static_cast<double>(h);
        const double wave = a * c + b * s;
        v.value += wave;
        v.slope += k * (b * c - a * s);
        v.curvature -= k * k * wave;
    }
    return v;
}

Matrix trig_grid(std::int64_t n_harmonics, std::int64_t n) {
    vector<double> cosine(n), sine(n);
    for (std::int64_t i = 0; i < n; ++i) {
        const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(n);
        cosine[i] = std::cos(angle), sine[i] = std::sin(angle);
    }
    Matrix grid(2 * n, 2 * n_harmonics + 1);
    for (std::int64_t i = 0; i < n; ++i) grid(i, 0) = 1;
    for (std::int64_t h = 1; h <= n_harmonics; ++h) {
        double *c = grid.col(2 * h - 1), *s = grid.col(2 * h);
        const double k = static_cast<double>(h);
        worked(20.0 * static_cast<double>(n));
        for (std::int64_t i = 0; i < n; ++i) {
            const std::int64_t at = (h * i) % n; // h 2 pi i / n, reduced in integers
            c[i] = cosine[at], s[i] = sine[at];
            c[n + i] = -k * sine[at], s[n + i] = k * cosine[at];
        }
    }
    return grid;
}

namespace {

// The last step, rad: the next one would be below rounding.
constexpr double last_newton = 1e-9, last_halley = 1e-6;

// Newton from `t` kept inside a bracket that shrinks; falls back to bisection when a step leaves it.
// Convergence is quadratic, so the step after a change below 1e-9 is below rounding and is not taken; for a
// zero of x (order 0; 1: of x') the curvature is at hand and makes it cubic (Halley).
double safeguarded_newton(const double *x, std::int64_t n_harmonics, double low, double high, double t,
                          bool low_positive, int order) {
    for (int k = 0; k < 60; ++k) {
        const TrigValue v = evaluate_trig(x, n_harmonics, t);
        const double f = order == 0 ? v.value : v.slope, df = order == 0 ? v.slope : v.curvature;
        if (f == 0) return t;
        ((f > 0) == low_positive ? low : high) = t;
        const double newton = f / df;
        const double bend = order == 0 ? 0.5 * newton * v.curvature / df : 0.0;
        const double step = std::abs(bend) < 0.5 ? newton / (1 - bend) : newton;
        if (std::abs(step) <= (order == 0 ? last_halley : last_newton)) return t - step;
        const double next = t - step;
        t = next > low && next < high ? next : 0.5 * (low + high);
        if (high - low <= 4e-16 * high) break;
    }
    return t;
}

// Zero of the cubic with the values and slopes of both ends, by the chord and two Newton steps: within the
// fourth power of the bracket's width.
double cubic_guess(const TrigEnd &low, const TrigEnd &high) {
    const double h = high.t - low.t, d = high.value - low.value;
    const double c2 = 3 * d - h * (2 * low.slope + high.slope), c3 = h * (low.slope + high.slope) - 2 * d;
    double s = -low.value / d;
    for (int k = 0; k < 2; ++k) {
        const double f = low.value + s * (h * low.slope + s * (c2 + s * c3)),
                     df = h * low.slope + s * (2 * c2 + s * 3 * c3);
        const double next = s - f / df;
        if (next > 0 && next < 1) s = next;
    }
    return low.t + h * s;
}

} // namespace

double trig_root(const double *x, std::int64_t n_harmonics, TrigEnd low, TrigEnd high) {
    return safeguarded_newton(x, n_harmonics, low.t, high.t, cubic_guess(low, high), low.value > 0, 0);
}

double trig_stationary(const double *x, std::int64_t n_harmonics, TrigEnd low, TrigEnd high) {
    const double fraction = low.slope / (low.slope - high.slope); // chord of x'
    return safeguarded_newton(x, n_harmonics, low.t, high.t, low.t + fraction * (high.t - low.t),
                              low.slope > 0, 1);
}

ValueRange trig_range(const double *x, std::int64_t n_harmonics) {
    ValueRange range{x[0], x[0]};
    if (n_harmonics == 0) return range;
    const std::int64_t n = std::max<std::int64_t>(64, 16 * n_harmonics);
    const double width = 2 * M_PI / static_cast<double>(n);
    TrigValue left = evaluate_trig(x, n_harmonics, 0.0);
    range = {left.value, left.value};
    for (std::int64_t i = 0; i < n; ++i) {
        const double t = width * static_cast<double>(i);
        worked(10.0 * static_cast<double>(n_harmonics));
        const TrigValue right = evaluate_trig(x, n_harmonics, t + width);
        double value = right.value;
        if ((left.slope > 0) != (right.slope > 0)) {
            const double inside = trig_stationary(x, n_harmonics, {t, left.value, left.slope},
                                                  {t + width, right.value, right.slope});
            value = evaluate_trig(x, n_harmonics, inside).value;
        }
        range.minimum = std::min({range.minimum, value, right.value});
        range.maximum = std::max({range.maximum, value, right.value});
        left = right;
    }
    return range;
}

} // namespace plm
