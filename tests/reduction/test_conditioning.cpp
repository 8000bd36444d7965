// Selection rules, conditioning and the static basis on coordinates made by hand.
#include "reduction/conditioning.hpp"
#include "reduction/mode_selection.hpp"
#include "reduction/static_basis.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <string>

using plm::Coordinates;
using plm::Matrix;
using plm::ModeSelection;
using plm::SelectionRule;
using plm::Space;

namespace {

Space space_with(std::initializer_list<double> lambda) {
    Space s;
    s.lambda = plm::vector<double>(lambda);
    return s;
}

Matrix columns(std::int64_t rows, std::initializer_list<double> by_column) {
    Matrix m(rows, static_cast<std::int64_t>(by_column.size()) / rows);
    std::copy(by_column.begin(), by_column.end(), m.data());
    return m;
}

// Largest deviation of Y^T Y from I and of Y^T diag(lambda) Y from diag(values).
double defect(const Space &space, const Coordinates &c) {
    double worst = 0;
    const std::int64_t r = c.y.cols();
    for (std::int64_t i = 0; i < r; ++i)
        for (std::int64_t j = 0; j < r; ++j) {
            double m = i == j ? -1 : 0, k = i == j ? -c.lambda[i] : 0;
            for (std::int64_t a = 0; a < c.y.rows(); ++a) {
                m += c.y(a, i) * c.y(a, j);
                k += c.y(a, i) * space.lambda[a] * c.y(a, j);
            }
            worst = std::max({worst, std::abs(m), std::abs(k) / space.lambda.back()});
        }
    return worst;
}

std::string kept(const SelectionRule &rule, std::initializer_list<double> frequencies) {
    std::string s;
    for (double f : frequencies) s += rule.keeps(f) ? 'x' : '.';
    return s;
}

void the_band_rule_keeps_windows_around_the_harmonics(void **) {
    SelectionRule rule;
    rule.selection = ModeSelection::bands;
    rule.min_hz = 95, rule.max_hz = 105, rule.n_harmonics = 3;
    assert_true(rule.highest_hz() == 315);
    assert_string_equal(
        kept(rule, {0, 94.9, 95, 100, 105, 105.1, 189, 190, 210, 211, 284, 285, 315, 316}).c_str(),
        "..xxx..xx..xx.");
}

void the_below_rule_keeps_everything_up_to_its_end(void **) {
    SelectionRule rule;
    rule.min_hz = 95, rule.max_hz = 105, rule.n_harmonics = 2, rule.below_factor = 1.5;
    assert_true(near(rule.highest_hz(), 315, 1e-13));
    assert_string_equal(kept(rule, {0, 50, 150, 314, 316}).c_str(), "xxxx.");
}

void repeated_columns_are_dropped(void **) {
    const Space space = space_with({1, 4, 9});
    const double c = std::cos(1e-8), s = std::sin(1e-8);
    const auto result =
        plm::condition_columns(space, columns(3, {1, 0, 0, 0, 1, 0, 1, 0, 0, c, s, 0, c, 0, s}), 1e-6);
    assert_int_equal(result.coordinates.y.cols(), 2);
    assert_int_equal(result.singular_values.size(), 3);
    assert_true(result.singular_values[0] == 1 && result.singular_values[2] < 1e-7);
    assert_true(below(defect(space, result.coordinates), 1e-14));
    assert_true(near(result.coordinates.lambda[0], 1, 1e-12) && near(result.coordinates.lambda[1], 4, 1e-12));
    // the tolerance decides: 1e-9 keeps the direction
    const auto all = plm::condition_columns(space, columns(3, {1, 0, 0, 0, 1, 0, c, 0, s}), 1e-9);
    assert_int_equal(all.coordinates.y.cols(), 3);
    assert_true(below(defect(space, all.coordinates), 1e-14));
}

void reduced_stiffness_is_diagonal_and_mass_the_identity(void **) {
    const Space space = space_with({1, 4, 9, 400});
    const auto result =
        plm::condition_columns(space, columns(4, {.8, .6, 0, 0, .6, 0, .8, 0, 0, 0, .6, .8}), 1e-6);
    assert_int_equal(result.coordinates.y.cols(), 3);
    assert_true(below(defect(space, result.coordinates), 1e-14));
    assert_true(std::is_sorted(result.coordinates.lambda.begin(), result.coordinates.lambda.end()));
}

void rigid_body_motion_stays_exactly_without_stiffness(void **) {
    const Space space = space_with({0, 4, 9});
    const auto result = plm::condition_columns(space, columns(3, {.8, .6, 0, .6, -.8, 0, .8, 0, .6}), 1e-6);
    assert_true(result.coordinates.lambda[0] == 0 && result.coordinates.lambda[1] > 1);
}

// What the tolerance leaves of a fast mode in the second direction, 5 % of it, must not become its stiffness:
// a free body under a dead load then had an equilibrium at kilometres, and a curve began there.
void rigid_body_motion_takes_no_stiffness_from_what_is_dropped(void **) {
    const Space space = space_with({0, 0, 4, 1e6});
    const auto result =
        plm::condition_columns(space, columns(4, {1, 0, 0, 0, 1, 1e-5, 0, 5e-7, 0.6, 0, 0.8, 0}), 1e-6);
    assert_int_equal(result.coordinates.lambda.size(), 3);
    assert_true(result.coordinates.lambda[0] == 0 && result.coordinates.lambda[1] == 0);
    assert_true(near(result.coordinates.lambda[2], 4, 1e-12));
}

// The columns span everything, so that the values are those of the space. A mode 1e14 times as fast as the
// slowest has a compliance of 1e-14 beside one of 1, in which rounding leaves two digits; Rayleigh's quotient
// has nine.
void fast_modes_keep_their_digits(void **) {
    const std::int64_t n = 12;
    Space space;
    Matrix mixed(n, n);
    for (std::int64_t i = 0; i < n; ++i) {
        space.lambda.push_back(i + 3 < n ? 1 + i : std::pow(1e2, i - 4)); // 1, 2, ... 9, 1e10, 1e12, 1e14
        for (std::int64_t j = 0; j < n; ++j) mixed(i, j) = std::cos(1.0 + 2.3 * i * j + 0.7 * j * j);
    }
    const Coordinates c = plm::condition_columns(space, mixed, 1e-9).coordinates;
    assert_int_equal(c.lambda.size(), n);
    for (std::int64_t i = 0; i < n; ++i) {
        double mass = 0;
        for (std::int64_t a = 0; a < n; ++a) mass += c.y(a, i) * c.y(a, i);
        assert_true(close_to(c.lambda[i], space.lambda[i], 1e-8) && near(mass, 1, 1e-12));
    }
}

void the_static_basis_contains_the_rest_displacement(void **) {
    const Space space = space_with({1, 4, 9, 16});
    const auto dynamic =
        plm::condition_columns(space, columns(4, {.8, .6, 0, 0, .6, 0, .8, 0}), 1e-6).coordinates;
    const plm::vector<double> q = plm::vector<double>({3, -1, 2, 5});
    const auto basis = plm::make_static_basis(space, dynamic, q);
    assert_false(basis.same);
    assert_int_equal(basis.coordinates.y.cols(), 3);
    assert_true(below(defect(space, basis.coordinates), 1e-14));
    assert_true(plm::relative_remainder(dynamic, q) > 0.1);
    assert_true(below(plm::relative_remainder(basis.coordinates, q), 1e-15));
}

void nothing_is_added_to_the_static_basis_without_need(void **) {
    const Space space = space_with({1, 4, 9});
    const auto dynamic = plm::condition_columns(space, columns(3, {.8, .6, 0, 0, 0, 1}), 1e-6).coordinates;
    assert_true(plm::make_static_basis(space, dynamic, plm::vector<double>(3, 0.0)).same);
    assert_true(plm::make_static_basis(space, dynamic, plm::vector<double>({1.6, 1.2, 7})).same);
    assert_true(plm::make_static_basis(space, dynamic, plm::vector<double>({1.6, 1.2 + 1e-12, 7})).same);
    assert_false(plm::make_static_basis(space, dynamic, plm::vector<double>({1.6, 1.2 + 1e-6, 7})).same);
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_band_rule_keeps_windows_around_the_harmonics),
        cmocka_unit_test(the_below_rule_keeps_everything_up_to_its_end),
        cmocka_unit_test(repeated_columns_are_dropped),
        cmocka_unit_test(reduced_stiffness_is_diagonal_and_mass_the_identity),
        cmocka_unit_test(rigid_body_motion_stays_exactly_without_stiffness),
        cmocka_unit_test(rigid_body_motion_takes_no_stiffness_from_what_is_dropped),
        cmocka_unit_test(fast_modes_keep_their_digits),
        cmocka_unit_test(the_static_basis_contains_the_rest_displacement),
        cmocka_unit_test(nothing_is_added_to_the_static_basis_without_need),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
