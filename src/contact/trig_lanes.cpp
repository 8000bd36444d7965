#include "contact/trig_lanes.hpp"

namespace plm {
namespace {

// Cosine c and sine s of an angle become those of its sum with another one.
template <class L> PLM_IN_LANES void turn(L &c, L &s, const L &cosine, const L &sine) {
    const L turned = c * cosine - s * sine;
    s = s * cosine + c * sine;
    c = turned;
}

// The same for an angle below 0.27, whose cosine and sine are summed as series, to rounding.
template <class L> PLM_IN_LANES void turn_little(L &c, L &s, const L &angle) {
    const L q = angle * angle;
    const L cosine =
        1 - 1. / 2 * q *
                (1 - 1. / 12 * q *
                         (1 - 1. / 30 * q * (1 - 1. / 56 * q * (1 - 1. / 90 * q * (1 - 1. / 132 * q)))));
    const L sine =
        angle *
        (1 - 1. / 6 * q * (1 - 1. / 20 * q * (1 - 1. / 42 * q * (1 - 1. / 72 * q * (1 - 1. / 110 * q)))));
    turn(c, s, cosine, sine);
}

template <class L>
PLM_IN_LANES L slope_at(std::int64_t n_harmonics, const double *x, const L &cosine, const L &sine) {
    L c = cosine, s = sine, slope{};
    for (std::int64_t h = 1; h <= n_harmonics; ++h) {
        const L a = L::load(x + (2 * h - 1) * n_lanes), b = L::load(x + 2 * h * n_lanes);
        slope += static_cast<double>(h) * (b * c - a * s);
        turn(c, s, cosine, sine);
    }
    return slope;
}

template <class L> struct LaneValue { L value, slope, curvature, third; };
template <class L>
PLM_IN_LANES LaneValue<L> value_at(std::int64_t n_harmonics, const double *x, const L &cosine,
                                   const L &sine) {
    L c = cosine, s = sine;
    LaneValue<L> v{L::load(x), {}, {}, {}};
    for (std::int64_t h = 1; h <= n_harmonics; ++h) {
        const L a = L::load(x + (2 * h - 1) * n_lanes), b = L::load(x + 2 * h * n_lanes);
        const double k = static_cast<double>(h);
        const L wave = a * c + b * s, slope = k * (b * c - a * s);
        v.value += wave;
        v.slope += slope;
        v.curvature -= k * k * wave;
        v.third -= k * k * slope;
        turn(c, s, cosine, sine);
    }
    return v;
}

// Where in a cell, 0 to 1, the values `low` and `high` with those slopes pass zero: by the cubic of the
// inverse function.
template <class L>
PLM_IN_LANES L inverse_cubic(const L &low, const L &high, const L &slope_low, const L &slope_high) {
    const L d = high - low, at = -low / d, rest = 1 - at, in_low = d / slope_low, in_high = d / slope_high;
    return at * (at + rest * (2 * at + rest * in_low - at * in_high));
}

// Is there one zero, by the bound of the third derivative: is the second certain to keep its sign, or the
// first?
template <class L>
PLM_IN_LANES typename L::Mask one_zero(const TrigCells &cells, const L &slope_low, const L &slope_high) {
    const L change = 0.5 * cells.width * cells.width * L::load(cells.twist);
    const auto one =
        (absolute(slope_high - slope_low) > change) |
        ((slope_low * slope_high > 0) & (smaller(absolute(slope_low), absolute(slope_high)) > 0.25 * change));
    return one & ((L::load(cells.low) > 0) ^ (L::load(cells.high) > 0));
}

// The step to a zero by the series of the inverse function to the third power, and where that is exact: as in
// trig_root().
template <class L> struct LaneStep {
    L back;
    typename L::Mask exact;
};
template <class L> PLM_IN_LANES LaneStep<L> series_step(std::int64_t n_harmonics, const LaneValue<L> &v) {
    const L newton = v.value / v.slope, half_bend = 0.5 * v.curvature / v.slope, bend = newton * half_bend,
            third = newton * newton * (2 * half_bend * half_bend - v.third / (6 * v.slope));
    return {newton * (1 + bend + third), (static_cast<double>(n_harmonics) * absolute(newton) < 1e-4) &
                                             (absolute(bend) < 1e-4) & (absolute(third) < 1e-8)};
}

template <class L>
PLM_IN_LANES void zeros(std::int64_t n_harmonics, const double *x, const TrigCells &cells, TrigZeros &out) {
    const L cosine = L::load(cells.cosine_low), sine = L::load(cells.sine_low), width = L::all(cells.width);
    const L slope_low = slope_at(n_harmonics, x, cosine, sine),
            slope_high = slope_at(n_harmonics, x, L::load(cells.cosine_high), L::load(cells.sine_high));
    const auto searched = one_zero(cells, slope_low, slope_high);
    L after =
        width * inverse_cubic(L::load(cells.low), L::load(cells.high), width * slope_low, width * slope_high);
    for (int evaluation = 1;; ++evaluation) { // one where the first harmonic is most of x, mostly
        const L at = smaller(larger(after, L{}), width);
        L c = cosine, s = sine;
        turn_little(c, s, at);
        const LaneStep<L> step = series_step(n_harmonics, value_at(n_harmonics, x, c, s));
        after = at - step.back;
        const auto found = searched & step.exact & (after > 0) & (after < cells.width);
        if (evaluation < 4 && (searched ^ found).any()) continue;
        const L square = step.back * step.back; // the fifth power is beyond rounding
        turn(c, s, 1 - 0.5 * square, step.back * ((1. / 6) * square - L::all(1)));
        after.store(out.after_low);
        c.store(out.cosine);
        s.store(out.sine);
        found.store(out.found);
        return;
    }
}

template <class L> PLM_IN_LANES void integrals(std::int64_t n_harmonics, const TrigEnds &ends, double *out) {
    const L c1 = L::load(ends.cosine_first), s1 = L::load(ends.sine_first), d1 = L::load(ends.cosine_second),
            e1 = L::load(ends.sine_second);
    L c = c1, s = s1, d = d1, e = e1;
    for (std::int64_t k = 1; k <= 2 * n_harmonics; ++k) {
        const double share = 1 / static_cast<double>(k);
        (share * (e - s)).store(out + (2 * k - 1) * n_lanes);
        (share * (c - d)).store(out + 2 * k * n_lanes);
        turn(c, s, c1, s1);
        turn(d, e, d1, e1);
    }
}

template <class L>
PLM_IN_LANES std::int64_t unclear(std::int64_t n, const double *low, const double *high, const double *bound,
                                  std::int64_t *out) {
    std::int64_t found = 0, i = 0;
    for (; i + n_lanes <= n; i += n_lanes) {
        const L a = L::load(low + i), b = L::load(high + i), limit = L::load(bound + i);
        const auto unclear = !(((a > limit) & (b > limit)) | ((a < -limit) & (b < -limit)));
        if (!unclear.any()) continue; // most
        bool is_unclear[n_lanes];
        unclear.store(is_unclear);
        for (std::int64_t l = 0; l < n_lanes; ++l)
            if (is_unclear[l]) out[found++] = i + l;
    }
    for (; i < n; ++i)
        if (!((low[i] > bound[i] && high[i] > bound[i]) || (low[i] < -bound[i] && high[i] < -bound[i])))
            out[found++] = i;
    return found;
}

// One pair, in place of lanes of them.
struct OneLane {
    double v;
    PLM_IN_LANES static OneLane load(const double *p) { return {*p}; }
    PLM_IN_LANES void store(double *p) const { *p = v; }
    PLM_IN_LANES friend OneLane operator+(OneLane x, OneLane y) { return {x.v + y.v}; }
    PLM_IN_LANES friend OneLane operator-(OneLane x, OneLane y) { return {x.v - y.v}; }
    PLM_IN_LANES friend OneLane operator*(OneLane x, OneLane y) { return {x.v * y.v}; }
    PLM_IN_LANES friend OneLane operator*(double x, OneLane y) { return {x * y.v}; }
    PLM_IN_LANES OneLane operator-() const { return {-v}; }
    PLM_IN_LANES OneLane &operator+=(OneLane y) { return *this = *this + y; }
};

// Averages lie `step` apart. The sums of indicator_entry() with what two rows and two columns have in common
// taken once.
template <class L>
PLM_IN_LANES void products(std::int64_t n_harmonics, const double *averages, std::int64_t step,
                           const double *stiffness, const double *x, std::int64_t stride, double *force) {
    const L k = L::load(stiffness), mean = L::load(x);
    const auto s = [=](std::int64_t i) __attribute__((always_inline)) {
        return L::load(averages + i * step);
    };
    L f = s(0) * mean;
    for (std::int64_t c = 1; c <= 2 * n_harmonics; ++c) f += s(c) * L::load(x + c * stride);
    (k * f).store(force);
    for (std::int64_t m = 1; m <= n_harmonics; ++m) {
        L c = 2 * s(2 * m - 1) * mean, d = 2 * s(2 * m) * mean;
        const auto add = [&](std::int64_t n, const L &cos_difference,
                             const L &sin_difference) __attribute__((always_inline)) { // of (m - n) t
            const L a = L::load(x + (2 * n - 1) * stride), b = L::load(x + 2 * n * stride);
            const L cos_sum = s(2 * (m + n) - 1), sin_sum = s(2 * (m + n));
            c += (cos_difference + cos_sum) * a + (sin_sum - sin_difference) * b;
            d += (sin_sum + sin_difference) * a + (cos_difference - cos_sum) * b;
        };
        for (std::int64_t n = 1; n < m; ++n) add(n, s(2 * (m - n) - 1), s(2 * (m - n)));
        add(m, s(0), L{});
        for (std::int64_t n = m + 1; n <= n_harmonics; ++n) add(n, s(2 * (n - m) - 1), -s(2 * (n - m)));
        (k * c).store(force + (2 * m - 1) * stride);
        (k * d).store(force + 2 * m * stride);
    }
}

using Any = Lanes<2>; // vectors of 16 bytes
using Wide = Lanes<4>;

PLM_WIDE_LANES void zeros_wide(std::int64_t n, const double *x, const TrigCells &cells, TrigZeros &out) {
    zeros<Wide>(n, x, cells, out);
}
PLM_WIDE_LANES void integrals_wide(std::int64_t n, const TrigEnds &ends, double *out) {
    integrals<Wide>(n, ends, out);
}
PLM_WIDE_LANES std::int64_t unclear_wide(std::int64_t n, const double *low, const double *high,
                                         const double *bound, std::int64_t *out) {
    return unclear<Wide>(n, low, high, bound, out);
}
PLM_WIDE_LANES void products_wide(std::int64_t n_harmonics, const double *averages, const double *stiffness,
                                  const double *x, std::int64_t stride, double *force) {
    products<Wide>(n_harmonics, averages, n_lanes, stiffness, x, stride, force);
}

} // namespace

void zeros_in_cells(std::int64_t n_harmonics, const double *x, const TrigCells &cells, TrigZeros &out,
                    bool wide) {
    wide ? zeros_wide(n_harmonics, x, cells, out) : zeros<Any>(n_harmonics, x, cells, out);
}

void integrals_between(std::int64_t n_harmonics, const TrigEnds &ends, double *out, bool wide) {
    wide ? integrals_wide(n_harmonics, ends, out) : integrals<Any>(n_harmonics, ends, out);
}

std::int64_t indices_unclear(std::int64_t n, const double *low, const double *high, const double *bound,
                             std::int64_t *out, bool wide) {
    return wide ? unclear_wide(n, low, high, bound, out) : unclear<Any>(n, low, high, bound, out);
}

void apply_averages(std::int64_t n_harmonics, const double *averages, const double *stiffness,
                    const double *x, std::int64_t stride, double *force, bool wide) {
    wide ? products_wide(n_harmonics, averages, stiffness, x, stride, force)
         : products<Any>(n_harmonics, averages, n_lanes, stiffness, x, stride, force);
}

void apply_averages_of_one(std::int64_t n_harmonics, const double *averages, double stiffness,
                           const double *x, std::int64_t stride, double *force) {
    products<OneLane>(n_harmonics, averages, 1, &stiffness, x, stride, force);
}

} // namespace plm
