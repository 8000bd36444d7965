// Vectors recovered from small matrices against the same ones formed.
#include "space/space.hpp"
#include "support/caught.hpp"
#include "support/spring_models.hpp"
#include "support/test.hpp"

using plm::Field;
using plm::Matrix;
using plm::SpaceVectors;

namespace {

constexpr std::int64_t n_columns = 7;

// A chain of unit masses and springs, held at one end, with a pair at each of the last nine masses.
std::shared_ptr<const plm::Space> space_of_chain() {
    constexpr std::size_t n = 80, n_pairs = 9;
    test::Dense m(n, std::vector<double>(n)), k = m;
    for (std::size_t i = 0; i < n; ++i) {
        m[i][i] = 1, k[i][i] = i + 1 < n ? 2 : 1;
        if (i > 0) k[i][i - 1] = k[i - 1][i] = -1;
    }
    plm::ModelInput in = test::input(m, k);
    for (std::size_t p = 0; p < n_pairs; ++p) {
        std::vector<double> row(n);
        row[n - 1 - p] = 1;
        test::add_pair(in, row, 3);
    }
    return plm::make_contact_space(test::build(in), 0.3, 10, plm::Watch());
}

Matrix patternless(std::int64_t rows, std::int64_t cols) {
    Matrix a(rows, cols);
    for (std::int64_t k = 0; k < rows * cols; ++k) a.data()[k] = std::sin(1.3 * static_cast<double>(k) + 0.4);
    return a;
}

double largest_difference(const Matrix &a, const Matrix &b) {
    double largest = a.rows() == b.rows() && a.cols() == b.cols() ? 0 : 1;
    for (std::int64_t k = 0; k < a.rows() * a.cols() && largest < 1; ++k)
        largest = std::max(largest, std::abs(a.data()[k] - b.data()[k]));
    return largest;
}

// Each way to ask on a handle of its own, which has formed nothing yet. Vectors of unit mass: entries are of
// the order of 1, and a solution leaves some hundred roundings.
void recovered_vectors_equal_formed_ones(void **) {
    const auto space = space_of_chain();
    const Matrix y = patternless(space->size(), n_columns), some = patternless(n_columns, 3);
    const auto basis = [&] { return space->vectors.times(y); };
    const SpaceVectors whole = basis();
    const Field &formed = whole.formed();
    const Field forces(patternless(formed.rows(), 3));
    constexpr double tolerance = 1e-10;
    assert_true(below(largest_difference(combine(space->vectors, y).in_core(), formed.in_core()), tolerance));
    assert_true(below(largest_difference(combine(basis(), some).in_core(), combine(formed, some).in_core()),
                      tolerance));
    assert_true(below(largest_difference(gram(basis(), forces), gram(formed, forces)), tolerance));
    assert_true(
        below(largest_difference(basis().rows_at({3, 40, 5}), formed.rows_at({3, 40, 5})), tolerance));
    assert_true(below(largest_difference(columns(basis(), 2, 4).in_core(), formed.columns(2, 4).in_core()),
                      tolerance));
    Field sum = forces, want = forces;
    add_combination(-0.5, basis(), some, sum);
    add_combination(-0.5, formed, some, want);
    assert_true(below(largest_difference(sum.in_core(), want.in_core()), tolerance));
    const plm::vector<double> row = basis().row({{11, 1.0}}), expected = formed.row({{11, 1.0}});
    for (std::size_t j = 0; j < row.size(); ++j) assert_true(std::abs(row[j] - expected[j]) < tolerance);
}

// Formed by the vector that makes them more than there are; copies share what was formed, and a DOF asked
// for again costs nothing.
void they_are_formed_once_where_that_is_less_work(void **) {
    const auto space = space_of_chain();
    const SpaceVectors basis = space->vectors.times(patternless(space->size(), n_columns)), copy = basis;
    for (int again = 0; again < 50; ++again) basis.row({{11, 1.0}});
    assert_false(basis.worth_forming(n_columns - 1));
    assert_true(copy.worth_forming(1));
    assert_ptr_equal(&basis.formed(), &copy.formed());
    for (int again = 0; again < 50; ++again) assert_false(space->vectors.worth_forming(space->size()));
    assert_int_equal(caught([&] { space->vectors.formed(); }).status, plm::status::internal);
}

// What is made from a formed basis takes its columns.
void a_basis_in_a_basis_is_the_product(void **) {
    const auto space = space_of_chain();
    const Matrix y = patternless(space->size(), n_columns), z = patternless(n_columns, 2);
    const SpaceVectors unformed = space->vectors.times(y), formed = space->vectors.times(y);
    formed.formed();
    assert_true(below(
        largest_difference(unformed.times(z).formed().in_core(), formed.times(z).formed().in_core()), 1e-10));
    assert_int_equal(formed.times(z).parts().of_responses.rows(), 0);
}

// V as it is, of a Craig-Bampton space: there without asking.
void given_vectors_are_there(void **) {
    const Matrix v = patternless(20, 4), y = patternless(4, 2);
    const SpaceVectors given{Field(v)};
    assert_true(given.worth_forming(1));
    assert_true(largest_difference(given.formed().in_core(), v) == 0);
    assert_true(
        below(largest_difference(given.times(y).formed().in_core(), plm::product('N', 'N', v, y)), 1e-14));
}

// V^T C V of a damping matrix that no mode knows of.
double damping_error() {
    constexpr int n = 12;
    test::Dense k = test::free_chain(n, 1), c = test::diagonal(n, 0.01);
    k[0][0] += 1;
    for (int i = 0; i < n; ++i) c[i][i] *= i + 1;
    plm::ModelInput in = test::input(test::diagonal(n, 1), k);
    in.damping_matrix = test::matrix(c);
    std::vector<double> row(n);
    row[n - 1] = 1;
    test::add_pair(in, row, 3);
    const auto space = plm::make_contact_space(test::build(in), 0.3, 10, plm::Watch());
    const Matrix v = space->vectors.whole().formed().in_core();
    Matrix cv = v;
    for (std::int64_t j = 0; j < v.cols(); ++j)
        for (std::int64_t i = 0; i < v.rows(); ++i) cv(i, j) *= 0.01 * static_cast<double>(i + 1);
    return largest_difference(space->damping, product('T', 'N', v, cv));
}
void a_damping_matrix_is_projected(void **) {
    assert_true(below(damping_error(), 1e-12));
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(recovered_vectors_equal_formed_ones),
        cmocka_unit_test(they_are_formed_once_where_that_is_less_work),
        cmocka_unit_test(a_basis_in_a_basis_is_the_product),
        cmocka_unit_test(given_vectors_are_there),
        cmocka_unit_test(a_damping_matrix_is_projected),
    };
    return cmocka_run_group_tests_name("space_vectors", tests, nullptr, nullptr);
}
