#include "hbm/trig_polynomial.hpp"
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
    Matrix grid(2 * n, 2 * n_harmonics + 1);
    for (std::int64_t i = 0; i < n; ++i) {
        grid(i, 0) = 1;
        for (std::int64_t h = 1; h <= n_harmonics; ++h) {
            // the angle is reduced in integers, so that high harmonics stay exact on the grid
            const double angle = 2 * M_PI * static_cast<double>((h * i) % n) / static_cast<double>(n);
            const double c = std::cos(angle), s = std::sin(angle), k = static_cast<double>(h);
            grid(i, 2 * h - 1) = c;
            grid(i, 2 * h) = s;
            grid(n + i, 2 * h - 1) = -k * s;
            grid(n + i, 2 * h) = k * c;
        }
    }
    return grid;
}

namespace {

// Newton kept inside a bracket that shrinks; falls back to bisection when a step leaves it. `order` 0: zero
// of x, 1: of x'.
double safeguarded_newton(const double *x, std::int64_t n_harmonics, double low, double high,
                          bool low_positive, int order) {
    double t = 0.5 * (low + high);
    for (int k = 0; k < 60; ++k) {
        const TrigValue v = evaluate_trig(x, n_harmonics, t);
        const double f = order == 0 ? v.value : v.slope, df = order == 0 ? v.slope : v.curvature;
        if (f == 0) return t;
        ((f > 0) == low_positive ? low : high) = t;
        double next = t - f / df;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        const double change = std::abs(next - t);
        t = next;
        if (change <= 4e-16 * (1 + std::abs(t))) break;
    }
    return t;
}

} // namespace

double trig_root(const double *x, std::int64_t n_harmonics, double low, double high, double x_low) {
    return safeguarded_newton(x, n_harmonics, low, high, x_low > 0, 0);
}

double trig_stationary(const double *x, std::int64_t n_harmonics, double low, double high, double slope_low) {
    return safeguarded_newton(x, n_harmonics, low, high, slope_low > 0, 1);
}

TrigRange trig_range(const double *x, std::int64_t n_harmonics) {
    TrigRange range{x[0], x[0]};
    if (n_harmonics == 0) return range;
    const std::int64_t n = std::max<std::int64_t>(64, 16 * n_harmonics);
    const double width = 2 * M_PI / static_cast<double>(n);
    TrigValue left = evaluate_trig(x, n_harmonics, 0.0);
    range = {left.value, left.value};
    for (std::int64_t i = 0; i < n; ++i) {
        const double t = width * static_cast<double>(i);
        const TrigValue right = evaluate_trig(x, n_harmonics, t + width);
        double value = right.value;
        if ((left.slope > 0) != (right.slope > 0)) {
            const double inside = trig_stationary(x, n_harmonics, t, t + width, left.slope);
            value = evaluate_trig(x, n_harmonics, inside).value;
        }
        range.minimum = std::min({range.minimum, value, right.value});
        range.maximum = std::max({range.maximum, value, right.value});
        left = right;
    }
    return range;
}

} // namespace plm
