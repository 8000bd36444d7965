// A diagonal system with springs along gap rows: modes and solutions against the closed form of two
// coordinates, from springs that do next to nothing to rigid ones.
#include "space/linear_contact.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <limits>

namespace {

using plm::Matrix;
using Reals = plm::vector<double>;

constexpr double all = std::numeric_limits<double>::infinity();

Matrix rows(std::initializer_list<std::initializer_list<double>> entries) {
    Matrix a(static_cast<std::int64_t>(entries.size()), static_cast<std::int64_t>(entries.begin()->size()));
    std::int64_t i = 0;
    for (const auto &row : entries) {
        std::int64_t j = 0;
        for (double v : row) a(i, j++) = v;
        ++i;
    }
    return a;
}

struct Pair {
    double low, high;
};
// Eigenvalues of diag(a, b) + k [1 1; 1 1] without a difference of large numbers.
Pair exact(double a, double b, double k) {
    const double trace = a + b + 2 * k, determinant = a * b + k * (a + b);
    const double high = 0.5 * (trace + std::hypot(a - b, 2 * k));
    return {determinant / high, high};
}

// Largest relative error of the lowest mode, and of the second one where `both`.
double error(const Reals &lambda, double k, bool both) {
    const plm::SpaceModes modes = plm::modes_with_springs(lambda, 0, rows({{1, 1}}), {k}, all);
    const Pair want = exact(lambda[0], lambda[1], k);
    if (modes.values.empty() || (both && modes.values.size() < 2)) return 1;
    const double low = std::abs(modes.values[0] / want.low - 1);
    return both ? std::max(low, std::abs(modes.values[1] / want.high - 1)) : low;
}
double worst(const Reals &lambda, const std::vector<double> &stiffnesses, bool both) {
    double largest = 0;
    for (double k : stiffnesses) largest = std::max(largest, error(lambda, k, both));
    return largest;
}

// The lowest mode does not feel how stiff the spring is: eps, not eps k / lambda.
void the_lowest_mode_keeps_its_digits_at_any_stiffness(void **) {
    assert_true(below(worst({1, 4}, {1e-6, 1e-3, 1, 1e3, 1e6, 1e9, 1e12, 1e15, 1e30}, false), 1e-14));
    assert_true(below(worst({1, 4}, {1e-6, 1e-3, 1, 1e3}, true), 1e-12)); // the upper one: eps k
}
// sigma = 0.01: eps (1 + lambda / sigma), and eps sigma where the spring holds the body softly
void a_free_body_on_a_spring(void **) {
    assert_true(below(worst({0, 1}, {1e-6, 1e-3, 1, 1e3}, true), 1e-10));
    assert_true(below(worst({0, 1}, {1e6, 1e9, 1e15}, false), 1e-13));
}
// One body held by 1e-12 of its own stiffness: both ends of the spectrum keep eps 1e6.
void a_soft_support_hides_no_spring(void **) {
    assert_true(below(worst({1e-12, 1}, {1e-9, 1e-6, 1e-3, 1}, true), 1e-9));
    assert_true(below(worst({1e-12, 1}, {1e6, 1e9, 1e15}, false), 1e-9));
}

// Rigid bodies: nothing but the springs gives a scale. k |g|^2 = 1000, and what is left stays exactly at
// rest.
bool two_masses_on_one_spring(double k) {
    const plm::SpaceModes modes = plm::modes_with_springs({0, 0}, 0, rows({{1, -3}}), {k}, all);
    return modes.values.size() == 2 && modes.values[0] == 0 && close_to(modes.values[1], 10 * k, 1e-12);
}
void bodies_without_any_stiffness(void **) {
    assert_true(two_masses_on_one_spring(1e-9));
    assert_true(two_masses_on_one_spring(100));
    assert_true(two_masses_on_one_spring(1e9));
}

// Three pairs along one direction of two coordinates: what they hold moves no more, and (1, -1) is left.
double lowest_of_held_thrice(double k) {
    return plm::modes_with_springs({1, 4}, 0, rows({{1, 1}, {1, 1}, {2, 2}}), {k, k, k}, all).values[0];
}
void more_pairs_than_they_can_move(void **) {
    for (double k : {1e9, 1e15, 1e20, 1e100}) assert_true(close_to(lowest_of_held_thrice(k), 2.5, 1e-8));
}

// (A + k g g^T) x = b has x = x_0 - A^-1 g k (g . x_0) / (1 + k g . A^-1 g); two right-hand sides at once.
double solution_error(double soft, double k) {
    const Reals pivot = {soft, 1};
    Matrix x = rows({{1, 0}, {0, 2}});
    plm::solve_with_springs(pivot, rows({{1, 1}}), {k}, x);
    const double determinant = soft + k * (1 + soft); // Cramer's rule for [soft + k, k; k, 1 + k]
    const double want[2][2] = {{(1 + k) / determinant, -2 * k / determinant},
                               {-k / determinant, 2 * (soft + k) / determinant}};
    double largest = 0;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            largest = std::max(largest, std::abs(x(i, j) - want[i][j]) / std::abs(want[i][j]));
    return largest;
}
void solutions_in_closed_form(void **) {
    for (double k : {1e-6, 1.0, 1e3, 1e6}) {
        assert_true(below(solution_error(0.5, k), 1e-9));   // 2 (soft + k) - 2 k: eps k
        assert_true(below(solution_error(1e-10, k), 1e-9)); // a soft coordinate
    }
}
void repeated_rows_share_the_force(void **) {
    Reals x = {1, 1};
    plm::solve_with_springs({1, 4}, rows({{1, 1}, {1, 1}}), {1e30, 1e30}, x); // rigid: x_0 = -x_1
    assert_true(near(x[0] + x[1], 0, 1e-12) && near(x[0], 0, 1e-12)); // minimum of 2.5 x^2 - (1 - 1) x
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_lowest_mode_keeps_its_digits_at_any_stiffness),
        cmocka_unit_test(a_free_body_on_a_spring),
        cmocka_unit_test(a_soft_support_hides_no_spring),
        cmocka_unit_test(bodies_without_any_stiffness),
        cmocka_unit_test(more_pairs_than_they_can_move),
        cmocka_unit_test(solutions_in_closed_form),
        cmocka_unit_test(repeated_rows_share_the_force),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
