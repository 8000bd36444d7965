// Products and triangular solves by rows in the processor's vectors, narrow and wide, against plain loops, at
// sizes around those of their blocks.
#include "linalg/lane_products.hpp"
#include "linalg/panel_lanes.hpp"
#include "support.hpp"
#include <limits>

using namespace test;
using plm::LaneBlock;

namespace {

constexpr std::int64_t sizes[] = {1, 3, 7, 8, 9, 20, 31, 32, 33, 58, 100, 300};

vector<bool> widths() {
    return plm::has_wide_lanes() ? vector<bool>{false, true} : vector<bool>{false};
}

/// Of sums of n terms of the order of one.
template <class T> double rounding(std::int64_t n) {
    return 8 * std::numeric_limits<T>::epsilon() * static_cast<double>(n + 4);
}

// Largest error of alpha A x + beta c over what rounding explains.
double error_of_sum(std::int64_t rows, std::int64_t n, bool wide) {
    const Matrix a = random_matrix(rows, n, 1), x = random_matrix(n, 1, 2), c = random_matrix(rows, 1, 3);
    vector<double> y(rows, std::numeric_limits<double>::quiet_NaN());
    plm::multiply_and_add(a, -0.7, x.data(), 0.3, c.data(), y.data(), wide);
    double worst = 0;
    for (std::int64_t i = 0; i < rows; ++i) {
        double sum = 0;
        for (std::int64_t j = 0; j < n; ++j) sum += a(i, j) * x(j, 0);
        worst = std::max(worst, std::abs(y[i] - (0.3 * c(i, 0) - 0.7 * sum)) / rounding<double>(n));
        if (std::isnan(y[i])) return 1e300;
    }
    return worst;
}
void a_product_is_added(void **) {
    for (bool wide : widths())
        for (std::int64_t rows : sizes)
            for (std::int64_t n : {1, 5, 58}) assert_true(error_of_sum(rows, n, wide) < 1);
}

double error_of_bound(std::int64_t rows, std::int64_t n, bool wide) {
    const Matrix a = random_matrix(rows, n, 1), x = random_matrix(n, 3, 2);
    vector<double> sizes_of(n), bound(rows, -1.0);
    for (std::int64_t j = 0; j < n; ++j) sizes_of[j] = 0.5 + static_cast<double>(j % 3);
    Matrix ax(rows, 3);
    plm::multiply_three_and_bound(a, x.data(), sizes_of.data(), ax.data(), bound.data(), wide);
    double worst = max_difference(ax, plm::product('N', 'N', a, x));
    for (std::int64_t i = 0; i < rows; ++i) {
        double sum = 0;
        for (std::int64_t j = 0; j < n; ++j) sum += std::abs(a(i, j)) * sizes_of[j];
        worst = std::max(worst, std::abs(bound[i] - sum));
    }
    return worst / (3 * rounding<double>(n));
}
void three_products_come_with_a_bound(void **) {
    for (bool wide : widths())
        for (std::int64_t rows : sizes) assert_true(error_of_bound(rows, 17, wide) < 1);
}

/// Unit lower triangular in its first n rows, with numbers above the diagonal that must not count.
template <class T> vector<T> panel(std::int64_t rows, std::int64_t n) {
    const Matrix a = random_matrix(rows, n, 7);
    vector<T> l(rows * n);
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < rows; ++i)
            l[i + j * rows] = static_cast<T>(i <= j ? 1e30 : a(i, j) / static_cast<double>(n));
    return l;
}

template <class T> LaneBlock<T> block(std::int64_t rows, std::int64_t nrhs, int seed) {
    const Matrix a = random_matrix(rows, nrhs, seed);
    LaneBlock<T> x(rows, nrhs);
    for (std::int64_t j = 0; j < nrhs; ++j)
        for (std::int64_t i = 0; i < rows; ++i) x(i, j) = static_cast<T>(a(i, j));
    return x;
}

// What L makes of the solution, less the right-hand side; then the same with L^T.
template <class T> double error_of_solves(std::int64_t n, std::int64_t nrhs, bool wide) {
    const std::int64_t rows = n + 3;
    const vector<T> l = panel<T>(rows, n);
    const LaneBlock<T> b = block<T>(n, nrhs, 4);
    LaneBlock<T> x = b, y = b;
    plm::solve_lower(n, l.data(), rows, x.all(), wide);
    plm::solve_lower_transposed(n, l.data(), rows, y.all(), wide);
    double worst = 0;
    for (std::int64_t j = 0; j < nrhs; ++j)
        for (std::int64_t i = 0; i < n; ++i) {
            double lower = x(i, j) - b(i, j), upper = y(i, j) - b(i, j);
            for (std::int64_t k = 0; k < i; ++k) lower += double(l[i + k * rows]) * x(k, j);
            for (std::int64_t k = i + 1; k < n; ++k) upper += double(l[k + i * rows]) * y(k, j);
            worst = std::max({worst, std::abs(lower), std::abs(upper)});
        }
    return worst / rounding<T>(n);
}
void triangles_are_solved(void **) {
    for (bool wide : widths())
        for (std::int64_t n : sizes)
            for (std::int64_t nrhs : {1, 8, 19}) {
                assert_true(error_of_solves<double>(n, nrhs, wide) < 1);
                assert_true(error_of_solves<float>(n, nrhs, wide) < 1);
            }
}

template <class T> double error_of_panels(std::int64_t rows, std::int64_t n, bool wide) {
    const std::int64_t nrhs = 11, ld = rows + 2;
    const Matrix a = random_matrix(ld, n, 5);
    vector<T> l(ld * n);
    for (std::int64_t k = 0; k < ld * n; ++k) l[k] = static_cast<T>(a.data()[k]);
    const LaneBlock<T> x = block<T>(n, nrhs, 1), z = block<T>(rows, nrhs, 2);
    LaneBlock<T> anew(rows, nrhs), added = z, taken = x;
    anew(0, 0) = std::numeric_limits<T>::quiet_NaN(); // is not read
    plm::multiply_panel<T>(rows, n, l.data(), ld, x.all(), -1, true, anew.all(), wide);
    plm::multiply_panel<T>(rows, n, l.data(), ld, x.all(), 1, false, added.all(), wide);
    plm::subtract_panel_transposed<T>(rows, n, l.data(), ld, z.all(), taken.all(), wide);
    double worst = 0;
    for (std::int64_t j = 0; j < nrhs; ++j) {
        for (std::int64_t i = 0; i < rows; ++i) {
            double sum = 0;
            for (std::int64_t k = 0; k < n; ++k) sum += double(l[i + k * ld]) * x(k, j);
            worst = std::max({worst, std::abs(anew(i, j) + sum), std::abs(added(i, j) - z(i, j) - sum)});
            if (std::isnan(anew(i, j))) return 1e300;
        }
        for (std::int64_t k = 0; k < n; ++k) {
            double sum = 0;
            for (std::int64_t i = 0; i < rows; ++i) sum += double(l[i + k * ld]) * z(i, j);
            worst = std::max(worst, std::abs(taken(k, j) - x(k, j) + sum));
        }
    }
    return worst / rounding<T>(std::max(rows, n));
}
void panels_are_multiplied(void **) {
    for (bool wide : widths())
        for (std::int64_t rows : sizes)
            for (std::int64_t n : {1, 4, 6, 70}) {
                assert_true(error_of_panels<double>(rows, n, wide) < 1);
                assert_true(error_of_panels<float>(rows, n, wide) < 1);
            }
}

// Tall matrices times few columns, or one, against rows one by one.
double error_of_tall(std::int64_t columns, double beta) {
    const std::int64_t rows = 40000, n = 60;
    const Matrix a = random_matrix(rows, n, 1), b = random_matrix(n, columns, 2),
                 d = random_matrix(rows, columns, 3), start = random_matrix(n, columns, 4);
    Matrix c = d, t = start;
    plm::gemm('N', 'N', 0.5, a, b, beta, c);
    plm::gemm('T', 'N', 0.5, a, d, beta, t);
    double worst = 0;
    for (std::int64_t j = 0; j < columns; ++j) {
        for (std::int64_t i = 0; i < rows; i += 997) {
            double sum = beta * d(i, j);
            for (std::int64_t k = 0; k < n; ++k) sum += 0.5 * a(i, k) * b(k, j);
            worst = std::max(worst, std::abs(c(i, j) - sum) / rounding<double>(n));
        }
        for (std::int64_t k = 0; k < n; ++k) {
            double sum = beta * start(k, j);
            for (std::int64_t i = 0; i < rows; ++i) sum += 0.5 * a(i, k) * d(i, j);
            worst = std::max(worst, std::abs(t(k, j) - sum) / rounding<double>(rows));
        }
    }
    return worst;
}
void tall_products_of_few_columns_are_right(void **) {
    for (std::int64_t columns : {1, 2, 8, 9})
        for (double beta : {0.0, 1.0, -0.5}) assert_true(error_of_tall(columns, beta) < 1);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_product_is_added),
        cmocka_unit_test(three_products_come_with_a_bound),
        cmocka_unit_test(triangles_are_solved),
        cmocka_unit_test(panels_are_multiplied),
        cmocka_unit_test(tall_products_of_few_columns_are_right),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
