#include "contact/polynomial.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace plm {
namespace {

using Coefficients = std::array<double, max_polynomial_degree + 1>;
constexpr int max_depth = 48; // halvings: below, two doubles in [0, 1] are hardly told apart

// b_j = sum_{i <= j} binomial(j, i) / binomial(n, i) c_i: repeated sums, weights in [0, 1].
void to_bernstein(const double *c, std::int64_t n, double *b) {
    double binomial = 1;
    for (std::int64_t i = 0; i <= n; ++i) {
        b[i] = c[i] / binomial;
        binomial *= static_cast<double>(n - i) / static_cast<double>(i + 1);
    }
    for (std::int64_t level = 1; level <= n; ++level)
        for (std::int64_t j = n; j >= level; --j) b[j] += b[j - 1];
}

// de Casteljau at 1/2: b becomes the right half, left the left one.
void halve(double *b, std::int64_t n, double *left) {
    left[0] = b[0];
    for (std::int64_t level = 1; level <= n; ++level) {
        for (std::int64_t j = 0; j <= n - level; ++j) b[j] = 0.5 * (b[j] + b[j + 1]);
        left[level] = b[0];
    }
}

class CrossingSearch {
  public:
    CrossingSearch(const double *c, std::int64_t n, double noise) : c_(c), n_(n), noise_(noise) {}

    double search(Coefficients &b, double low, double high, int depth) const {
        if (*std::min_element(b.begin(), b.begin() + n_ + 1) >= -noise_) return -1;
        if (b[0] <= 0 || depth == max_depth) return low;
        if (b[n_] < 0 && sign_changes(b) == 1) return single_zero(low, high);
        Coefficients left;
        halve(b.data(), n_, left.data());
        const double middle = 0.5 * (low + high), first = search(left, low, middle, depth + 1);
        return first >= 0 ? first : search(b, middle, high, depth + 1);
    }

  private:
    int sign_changes(const Coefficients &b) const {
        int changes = 0;
        for (std::int64_t j = 1; j <= n_; ++j) changes += (b[j] > 0) != (b[j - 1] > 0);
        return changes;
    }

    // Newton kept inside a bracket with p(low) > 0 >= p(high).
    double single_zero(double low, double high) const {
        double s = 0.5 * (low + high);
        for (int k = 0; k < 200; ++k) {
            double p = c_[n_], slope = 0;
            for (std::int64_t i = n_ - 1; i >= 0; --i) {
                slope = slope * s + p;
                p = p * s + c_[i];
            }
            (p > 0 ? low : high) = s;
            double next = s - p / slope;
            if (!(next > low && next < high)) next = 0.5 * (low + high);
            if (next == s || next <= low || next >= high) break;
            if (std::abs(next - s) <= 1e-16 * s) return next;
            s = next;
        }
        return s;
    }

    const double *c_;
    std::int64_t n_;
    double noise_;
};

// The largest value of the polynomial over its interval, raised into `best`.
void raise_maximum(Coefficients &b, std::int64_t n, int depth, double resolution, double &best) {
    best = std::max({best, b[0], b[n]});
    const double bound = *std::max_element(b.begin(), b.begin() + n + 1);
    if (bound <= best + resolution || depth == max_depth) return;
    Coefficients left;
    halve(b.data(), n, left.data());
    raise_maximum(left, n, depth + 1, resolution, best);
    raise_maximum(b, n, depth + 1, resolution, best);
}

} // namespace

double evaluate_polynomial(const double *c, std::int64_t n, double s) {
    double p = c[n];
    for (std::int64_t i = n - 1; i >= 0; --i) p = p * s + c[i];
    return p;
}

double first_crossing(const double *c, std::int64_t n, double noise) {
    double reach = 0; // |p - p(0)| is nowhere larger
    for (std::int64_t i = 1; i <= n; ++i) reach += std::abs(c[i]);
    if (c[0] >= reach) return -1;
    Coefficients b;
    to_bernstein(c, n, b.data());
    return CrossingSearch(c, n, noise).search(b, 0.0, 1.0, 0);
}

void widen_range(const double *c, std::int64_t n, double &minimum, double &maximum) {
    double reach = 0;
    for (std::int64_t i = 1; i <= n; ++i) reach += std::abs(c[i]);
    if (c[0] + reach <= maximum && c[0] - reach >= minimum) return;
    Coefficients b, negative;
    to_bernstein(c, n, b.data());
    for (std::int64_t i = 0; i <= n; ++i) negative[i] = -b[i];
    const double resolution = 8e-15 * (std::abs(c[0]) + reach); // of the coefficients: no halving gets below
    double lowest = -minimum;
    raise_maximum(b, n, 0, resolution, maximum);
    raise_maximum(negative, n, 0, resolution, lowest);
    minimum = -lowest;
}

} // namespace plm
