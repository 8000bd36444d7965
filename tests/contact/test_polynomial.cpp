// First zeros and extrema of polynomials on [0, 1], against polynomials made from their zeros.
#include "contact/polynomial.hpp"
#include "support/test.hpp"
#include <limits>
#include <vector>

namespace {

// scale * product (1 - s / zero): positive at 0
std::vector<double> from_zeros(const std::vector<double> &zeros) {
    std::vector<double> c{1};
    for (double z : zeros) {
        c.push_back(0);
        for (std::size_t i = c.size() - 1; i > 0; --i) c[i] -= c[i - 1] / z;
    }
    return c;
}
double first(const std::vector<double> &zeros, double noise = 1e-14) {
    const std::vector<double> c = from_zeros(zeros);
    return plm::first_crossing(c.data(), static_cast<std::int64_t>(c.size()) - 1, noise);
}

void the_first_zero_is_found(void **) {
    assert_true(near(first({0.3}), 0.3, 1e-15));
    assert_true(near(first({0.7, 0.25, 0.9}), 0.25, 1e-14));
    assert_true(near(first({0.5, -0.2, 3}), 0.5, 1e-15));
    assert_true(near(first({1e-9, 0.5}), 1e-9, 1e-20));
    assert_true(near(first({1.0}), -1, 0)); // reached at the very end, not crossed
}

void no_zero_is_no_event(void **) {
    assert_true(first({1.5, 2}) == -1);
    assert_true(first({-0.5}) == -1);
    const double rising[] = {1e-3, 5, -1}, waving[] = {1, -3.9, 3.9};
    assert_true(plm::first_crossing(rising, 2, 1e-16) == -1);
    assert_true(plm::first_crossing(waving, 2, 1e-16) == -1); // down to 0.025
}

// (s - a)^2 - depth^2: the closer the two zeros, the easier to step over.
void grazing_zeros_are_told_from_near_misses(void **) {
    for (double depth : {1e-2, 1e-4, 1e-6}) {
        const double a = 1.0 / 3, dip[] = {a * a - depth * depth, -2 * a, 1},
                     miss[] = {a * a + depth * depth, -2 * a, 1};
        assert_true(near(plm::first_crossing(dip, 2, 1e-16), a - depth, 1e-15 / depth));
        assert_true(plm::first_crossing(miss, 2, 1e-16) == -1);
    }
    const double touch[] = {1.0 / 9, -2.0 / 3, 1};
    assert_true(plm::first_crossing(touch, 2, 1e-14) == -1); // a double zero does not cross
}

void dips_within_the_noise_do_not_count(void **) {
    const double c[] = {0.25 - 1e-10, -1, 1}; // down to -1e-10
    assert_true(plm::first_crossing(c, 2, 1e-9) == -1);
    assert_true(near(plm::first_crossing(c, 2, 1e-11), 0.5 - 1e-5, 1e-9));
}

// cos(x s) by its series: extremes 1 and -1, zero at pi / (2 x).
std::vector<double> cosine_series(double x, int degree) {
    std::vector<double> c(degree + 1);
    double term = 1;
    for (int k = 0; k <= degree; ++k) {
        if (k > 0) term *= x / k;
        c[k] = k % 2 ? 0 : (k % 4 ? -term : term);
    }
    return c;
}
void series_of_high_degree_are_searched_to_rounding(void **) {
    const auto c = cosine_series(4, 40);
    assert_true(near(plm::first_crossing(c.data(), 40, 1e-14), M_PI / 8, 3e-15));
    std::vector<double> s = c;
    s[0] += 0.25;
    double low = INFINITY, high = -INFINITY;
    plm::widen_range(s.data(), 40, low, high);
    assert_true(near(high, 1.25, 1e-14));
    s[0] -= 0.5;
    plm::widen_range(s.data(), 40, low, high);
    assert_true(near(low, -1.25, 5e-13)); // terms up to 27
    assert_true(near(high, 1.25, 1e-14));
    low = -2, high = 2; // wider already
    plm::widen_range(s.data(), 40, low, high);
    assert_true(low == -2 && high == 2);
    const double constant[] = {0.7, 0, 0, 0};
    low = INFINITY, high = -INFINITY;
    plm::widen_range(constant, 3, low, high);
    assert_true(low == 0.7 && high == 0.7);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_first_zero_is_found),
        cmocka_unit_test(no_zero_is_no_event),
        cmocka_unit_test(grazing_zeros_are_told_from_near_misses),
        cmocka_unit_test(dips_within_the_noise_do_not_count),
        cmocka_unit_test(series_of_high_degree_are_searched_to_rounding),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
