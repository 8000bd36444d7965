// Integrals of powers times exponentials against Gauss's quadrature.
#include "orbits/exponential_integrals.hpp"
#include "support/test.hpp"
#include <cmath>

namespace {

using Complex = std::complex<double>;

using Exact = std::complex<long double>;

// Integral over [0, 1] by Gauss's rule of five points on many parts: exact to rounding for what is asked
// here.
template <class F> Exact quadrature(F f) {
    constexpr long double at[] = {0.538469310105683091036L, 0.906179845938663992798L},
                          weight[] = {0.478628670499366468041L, 0.236926885056189087514L},
                          in_the_middle = 128.0L / 225;
    constexpr int parts = 1000;
    Exact sum = 0;
    for (int i = 0; i < parts; ++i) {
        const long double half = 0.5L / parts, middle = (2 * i + 1) * half;
        sum += half * in_the_middle * f(middle);
        for (int k = 0; k < 2; ++k)
            sum += half * weight[k] * (f(middle - half * at[k]) + f(middle + half * at[k]));
    }
    return sum;
}

// Of the largest integrand, which is 1 or hardly more.
constexpr double rounding = 3e-15;

const Complex rates[] = {{0, 0},      {0, -1e-9}, {-1e-5, 1e-5}, {0, 0.02},   {-0.04, 0},
                         {0.3, -0.2}, {0, -3},    {-2, 11.5},    {0, 24.999}, {-30, 1},
                         {0, -25.5},  {-5, 60},   {0, 300},      {-800, 0}};

void moments_of_slow_and_fast_exponentials(void **) {
    plm::vector<Complex> m;
    for (const Complex rate : rates)
        for (const int degree : {0, 1, 5, 25}) {
            plm::exponential_moments(rate, std::exp(rate), degree, m);
            assert_int_equal(m.size(), degree + 1);
            for (int k = 0; k <= degree; ++k) {
                const Exact right =
                    quadrature([&](long double s) { return std::pow(s, k) * std::exp(Exact(rate) * s); });
                assert_true(std::abs(Exact(m[static_cast<std::size_t>(k)]) - right) < rounding);
            }
        }
}

void integrals_of_exponentials(void **) {
    for (const Complex rate : rates)
        for (const double duration : {0.01, 1.0}) {
            const Exact right =
                quadrature([&](long double s) { return std::exp(Exact(rate * duration) * s); });
            const Complex got =
                plm::exponential_integral(rate, duration, std::exp(rate * duration)) / duration;
            assert_true(std::abs(Exact(got) - right) < rounding);
        }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {cmocka_unit_test(moments_of_slow_and_fast_exponentials),
                                cmocka_unit_test(integrals_of_exponentials)};
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
