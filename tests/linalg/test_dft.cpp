// Fourier transforms: known signals, round trip, and both ways of computing them.
#include "linalg/dft.hpp"
#include "support.hpp"
#include <cstring>

using namespace test;

namespace {

constexpr double two_pi = 6.283185307179586476925;

/// The definition, term by term.
Matrix synthesis_by_definition(const Matrix &c, std::int64_t n) {
    Matrix x(n, c.cols());
    for (std::int64_t s = 0; s < c.cols(); ++s)
        for (std::int64_t k = 0; k < n; ++k) {
            x(k, s) = c(0, s);
            for (std::int64_t h = 1; 2 * h < c.rows(); ++h) {
                const double angle = two_pi * static_cast<double>(h * k % n) / static_cast<double>(n);
                x(k, s) += c(2 * h - 1, s) * std::cos(angle) + c(2 * h, s) * std::sin(angle);
            }
        }
    return x;
}

struct Shape {
    std::int64_t harmonics, samples;
};
// up to 16 harmonics: matrix product; above: FFTW where built. Odd, even, minimal and prime numbers of
// samples.
const Shape shapes[] = {{0, 1},    {0, 8},   {1, 3},   {5, 64},    {16, 33},
                        {16, 256}, {17, 35}, {17, 64}, {40, 1024}, {50, 101}};

void to_time_is_the_fourier_series(void **) {
    for (const Shape &s : shapes) {
        const Matrix c = random_matrix(2 * s.harmonics + 1, 3, 1);
        Matrix x;
        plm::Dft(s.harmonics, s.samples).to_time(c, x);
        assert_true(max_difference(x, synthesis_by_definition(c, s.samples)) <
                    1e-14 * static_cast<double>(4 + 2 * s.harmonics));
    }
}

void frequency_time_frequency_is_the_identity(void **) {
    for (const Shape &s : shapes) {
        const plm::Dft dft(s.harmonics, s.samples);
        const Matrix c = random_matrix(2 * s.harmonics + 1, 3, 2);
        Matrix x, back;
        for (int again = 0; again < 2; ++again) { // the second time on arrays with contents
            dft.to_time(c, x);
            dft.to_frequency(x, back);
        }
        assert_true(max_difference(back, c) < 2e-14);
    }
}

void harmonics_above_the_truncation_are_cut_off(void **) {
    for (std::int64_t h : {5, 20}) {
        Matrix c(2 * 30 + 1, 1), x, truncated;
        for (std::int64_t i = 0; i < 61; ++i) c(i, 0) = 1.0 / static_cast<double>(1 + i);
        plm::Dft(30, 128).to_time(c, x);
        plm::Dft(h, 128).to_frequency(x, truncated);
        double error = 0;
        for (std::int64_t i = 0; i <= 2 * h; ++i)
            error = std::max(error, std::fabs(truncated(i, 0) - c(i, 0)));
        assert_true(error < 1e-14);
    }
}

/// Coefficients 0..16 of the same samples by the product (H = 16) and by FFTW (H = 17, where built).
void both_ways_agree(void **) {
    const Matrix x = random_matrix(512, 4, 3);
    Matrix few, more;
    plm::Dft(16, 512).to_frequency(x, few);
    plm::Dft(17, 512).to_frequency(x, more);
    double error = 0;
    for (std::int64_t s = 0; s < 4; ++s)
        for (std::int64_t i = 0; i < few.rows(); ++i)
            error = std::max(error, std::fabs(few(i, s) - more(i, s)));
    assert_true(error < 1e-13 * max_abs(few));
}

void too_few_samples_are_refused(void **) {
    for (const Shape &s : {Shape{-1, 8}, Shape{4, 8}, Shape{0, 0}, Shape{1, -5}, Shape{INT64_MAX, 7}}) {
        const auto o = outcome_of([&] { plm::Dft(s.harmonics, s.samples); });
        assert_int_equal(o.status, plm::status::argument);
    }
    const auto o = outcome_of([] {
        Matrix x;
        plm::Dft(2, 8).to_time(Matrix(4, 1), x);
    });
    assert_int_equal(o.status, plm::status::internal);
}

void the_backend_names_itself(void **) {
    const std::string name = plm::dft_backend();
    assert_true(name == "matrix product" || (name.rfind("FFTW 3.", 0) == 0 && name.size() < 14));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(to_time_is_the_fourier_series),
        cmocka_unit_test(frequency_time_frequency_is_the_identity),
        cmocka_unit_test(harmonics_above_the_truncation_are_cut_off),
        cmocka_unit_test(both_ways_agree),
        cmocka_unit_test(too_few_samples_are_refused),
        cmocka_unit_test(the_backend_names_itself),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
