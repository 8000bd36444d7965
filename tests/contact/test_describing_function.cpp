// The describing function of a contact pair against sums over many instants, and its limits.
#include "contact/describing_function.hpp"
#include "support/test.hpp"
#include <algorithm>

namespace {

// Coefficient h of the force by the midpoint rule; the kinks leave an error of about (2 pi / n)^2.
double sampled(double k, double mean, double amplitude, int h) {
    const int n = 20000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const double t = 2 * M_PI * (i + 0.5) / n;
        sum += std::max(0.0, k * (mean + amplitude * std::cos(t))) * std::cos(h * t);
    }
    return sum / n * (h == 0 ? 1 : 2);
}

void coefficients_are_those_of_the_force_in_time(void **) {
    for (double mean : {-2.0, -1.2, -0.5, 0.0, 0.7, 1.2, 3.0})
        for (double amplitude : {1.2, -1.2, 0.4})
            for (int h = 0; h <= 6; ++h)
                assert_true(near(plm::force_coefficient(5, mean, amplitude, h),
                                 sampled(5, mean, amplitude, h), 1e-6));
}

void without_gap_half_of_the_stiffness_is_left(void **) {
    for (double amplitude : {1e-8, 1.0, 1e8})
        assert_true(close_to(plm::equivalent_stiffness(7, 0, amplitude), 3.5, 1e-14));
}

void a_pair_that_never_switches_is_a_spring_or_nothing(void **) {
    for (double amplitude : {0.0, 0.3, -1.0}) {
        assert_true(plm::equivalent_stiffness(7, -1.0, amplitude) == 0 &&
                    plm::mean_tangent(7, -1.0, amplitude) == 0);
        assert_true(close_to(plm::equivalent_stiffness(7, 1.0, amplitude), 7, 1e-14));
        assert_true(close_to(plm::mean_tangent(7, 1.0, amplitude), 7, 1e-14));
        assert_true(close_to(plm::force_coefficient(7, 1.0, amplitude, 0), 7, 1e-14));
    }
}

void the_mean_tangent_is_the_derivative_of_the_mean_force(void **) {
    const double step = 1e-5; // error of the central difference about step^2
    for (double mean : {-0.9, -0.2, 0.0, 0.8}) {
        const double later = plm::force_coefficient(3, mean + step, 1.1, 0),
                     sooner = plm::force_coefficient(3, mean - step, 1.1, 0);
        assert_true(near(plm::mean_tangent(3, mean, 1.1), (later - sooner) / (2 * step), 1e-8));
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(coefficients_are_those_of_the_force_in_time),
        cmocka_unit_test(without_gap_half_of_the_stiffness_is_left),
        cmocka_unit_test(a_pair_that_never_switches_is_a_spring_or_nothing),
        cmocka_unit_test(the_mean_tangent_is_the_derivative_of_the_mean_force),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
