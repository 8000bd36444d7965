#include "contact/trig_polynomial.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

namespace {

TrigValue evaluate(const double *x, std::int64_t n_harmonics, double c1, double s1) {
    double c = 1, s = 0;
    TrigValue v{x[0], 0, 0, 0};
    for (std::int64_t h = 1; h <= n_harmonics; ++h) {
        const double next = c * c1 - s * s1;
        s = s * c1 + c * s1;
        c = next;
        const double a = x[2 * h - 1], b = x[2 * h], k = static_cast<double>(h);
        const double wave = a * c + b * s, slope = k * (b * c - a * s);
        v.value += wave;
        v.slope += slope;
        v.curvature -= k * k * wave;
        v.third -= k * k * slope;
    }
    return v;
}

} // namespace

TrigValue evaluate_trig(const double *x, std::int64_t n_harmonics, double t) {
    return evaluate(x, n_harmonics, std::cos(t), std::sin(t));
}

Matrix trig_grid(std::int64_t n_harmonics, std::int64_t n) {
    Matrix grid(n, 2 * n_harmonics + 1);
    vector<double> cosine(n), sine(n);
    for (std::int64_t i = 0; i < n; ++i) {
        const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(n);
        cosine[i] = std::cos(angle), sine[i] = std::sin(angle);
        grid(i, 0) = 1;
    }
    for (std::int64_t h = 1; h <= n_harmonics; ++h) {
        worked(20.0 * static_cast<double>(n));
        for (std::int64_t i = 0; i < n; ++i) {
            const std::int64_t at = (h * i) % n; // h 2 pi i / n, reduced in integers
            grid(i, 2 * h - 1) = cosine[at], grid(i, 2 * h) = sine[at];
        }
    }
    return grid;
}

namespace {

// A step (rad) after which the next one would be below rounding, its error being the cube of itself, and one
// times the harmonics or the bend after which the third order is exact, the error being the fourth power.
constexpr double last_halley = 1e-6, last_series = 1e-4;

// From cosine and sine of t those of t - step, which is short: the fifth power is beyond rounding.
TrigInstant step_back(double t, double c, double s, double step) {
    const double square = step * step, cosine = 1 - square * (0.5 - square / 24),
                 sine = step * (1 - square / 6);
    return {t - step, c * cosine + s * sine, s * cosine - c * sine};
}

// Halley's method from `t` kept inside a bracket that shrinks, for a zero of x (order 0) or of x' (1); falls
// back to bisection when a step leaves it. Convergence is cubic. The last step to a zero of x goes by the
// series of the inverse function to the third power, which mostly is the first.
template <int order>
TrigInstant bracketed_zero(const double *x, std::int64_t n_harmonics, double low, double high, double t,
                           bool low_positive) {
    for (int k = 0; k < 60; ++k) {
        const double cosine = std::cos(t), sine = std::sin(t);
        const TrigValue v = evaluate(x, n_harmonics, cosine, sine);
        const double f = order == 0 ? v.value : v.slope, df = order == 0 ? v.slope : v.curvature,
                     ddf = order == 0 ? v.curvature : v.third;
        if (f == 0) return {t, cosine, sine};
        ((f > 0) == low_positive ? low : high) = t;
        const double newton = f / df, half_bend = 0.5 * ddf / df;
        const double bend = newton * half_bend,
                     third = newton * newton * (2 * half_bend * half_bend - v.third / (6 * df));
        if (order == 0 && std::abs(newton) * static_cast<double>(n_harmonics) <= last_series &&
            std::abs(bend) <= last_series && std::abs(third) <= last_series * last_series)
            return step_back(t, cosine, sine, newton * (1 + bend + third));
        const double step = std::abs(bend) < 0.5 ? newton / (1 - bend) : newton;
        if (std::abs(step) <= last_halley) return step_back(t, cosine, sine, step);
        const double next = t - step;
        t = next > low && next < high ? next : 0.5 * (low + high);
        if (high - low <= 4e-16 * high) break;
    }
    return {t, std::cos(t), std::sin(t)};
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

TrigInstant trig_root(const double *x, std::int64_t n_harmonics, TrigEnd low, TrigEnd high) {
    return bracketed_zero<0>(x, n_harmonics, low.t, high.t, cubic_guess(low, high), low.value > 0);
}

double trig_stationary(const double *x, std::int64_t n_harmonics, TrigEnd low, TrigEnd high) {
    const double fraction = low.slope / (low.slope - high.slope); // chord of x'
    return bracketed_zero<1>(x, n_harmonics, low.t, high.t, low.t + fraction * (high.t - low.t),
                             low.slope > 0)
        .t;
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
