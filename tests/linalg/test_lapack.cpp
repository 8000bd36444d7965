// Dense products, eigenproblems, singular values, least squares.
#include "linalg/lapack.hpp"
#include "support.hpp"
#include <limits>

using namespace test;

namespace {

Matrix random_symmetric(std::int64_t n, std::uint64_t seed) {
    Matrix a = random_matrix(n, n, seed);
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < j; ++i) a(i, j) = a(j, i);
    return a;
}
Matrix random_spd(std::int64_t n, std::uint64_t seed) {
    const Matrix r = random_matrix(n, n, seed);
    Matrix a = plm::product('T', 'N', r, r);
    for (std::int64_t i = 0; i < n; ++i) a(i, i) += 1;
    return a;
}
/// |A V - B V diag(values)|
double eigen_residual(const Matrix &a, const Matrix &b, const plm::SymmetricEigen &e) {
    Matrix right = plm::product('N', 'N', b, e.vectors);
    for (std::int64_t j = 0; j < right.cols(); ++j)
        for (std::int64_t i = 0; i < right.rows(); ++i) right(i, j) *= e.values[j];
    return max_difference(plm::product('N', 'N', a, e.vectors), right);
}
Matrix identity(std::int64_t n) {
    Matrix m(n, n);
    for (std::int64_t i = 0; i < n; ++i) m(i, i) = 1;
    return m;
}

void products_agree_for_all_transposes(void **) {
    const Matrix a = random_matrix(5, 7, 1), b = random_matrix(7, 4, 2);
    const Matrix at = a.transposed(), bt = b.transposed(), c = plm::product('N', 'N', a, b);
    assert_true(max_difference(c, plm::product('T', 'N', at, b)) < 1e-14);
    assert_true(max_difference(c, plm::product('N', 'T', a, bt)) < 1e-14);
    assert_true(max_difference(c, plm::product('T', 'T', at, bt)) < 1e-14);
    double y[5] = {1, 1, 1, 1, 1};
    plm::gemv('N', 2, a, b.col(3), 3, y);
    assert_true(std::fabs(y[2] - (2 * c(2, 3) + 3)) < 1e-14);
    plm::gemv('N', 1, Matrix(5, 0), nullptr, 2, y); // no columns: y is still scaled
    assert_true(std::fabs(y[2] - 2 * (2 * c(2, 3) + 3)) < 1e-13);
}

void wrong_shapes_never_reach_blas(void **) {
    const auto inner = outcome_of([] { plm::product('N', 'N', Matrix(2, 3), Matrix(2, 3)); });
    const auto op = outcome_of([] { plm::product('X', 'N', Matrix(2, 2), Matrix(2, 2)); });
    const auto empty = outcome_of([] { plm::product('T', 'N', Matrix(0, 3), Matrix(0, 2)); });
    assert_int_equal(inner.status, plm::status::internal);
    assert_int_equal(op.status, plm::status::internal);
    assert_int_equal(empty.status, plm::status::ok);
}

void append_and_columns_keep_the_data(void **) {
    Matrix a = random_matrix(6, 3, 1);
    const Matrix original = a;
    a.append(a);
    assert_int_equal(a.cols(), 6);
    assert_true(max_difference(a.columns(3, 3), original) == 0);
    Matrix none;
    none.append(original);
    assert_true(max_difference(none, original) == 0);
    Matrix grown;
    grown.reserve(6, 6);
    const double *storage = grown.data();
    grown.append(original);
    grown.append(original);
    assert_true(grown.data() == storage && max_difference(grown, a) == 0);
    grown.cut(3);
    assert_true(max_difference(grown, original) == 0);
    const double huge[] = {3e200, 4e200};
    assert_true(std::fabs(plm::norm2(2, huge) / 5e200 - 1) < 1e-14);
}

void symmetric_eigenpairs_reproduce_the_matrix(void **) {
    const Matrix a = random_symmetric(40, 3);
    const auto e = plm::symmetric_eigen(a);
    assert_true(eigen_residual(a, identity(40), e) < 1e-12);
    assert_true(distance_from_identity(e.vectors, e.vectors) < 1e-12);
    assert_true(std::is_sorted(e.values.begin(), e.values.end()));
    assert_int_equal(plm::symmetric_eigen(Matrix()).values.size(), 0);
}

void eigenpairs_below_a_bound_are_those_of_the_full_problem(void **) {
    const Matrix a = random_symmetric(50, 4);
    const auto all = plm::symmetric_eigen(a);
    for (double upper : {-100.0, -1.0, 0.0, 1.5, 1e3, HUGE_VAL, -HUGE_VAL}) {
        const auto some = plm::symmetric_eigen_below(a, upper);
        const auto expected =
            std::upper_bound(all.values.begin(), all.values.end(), upper) - all.values.begin();
        assert_int_equal(some.values.size(), expected);
        assert_int_equal(some.vectors.cols(), expected);
        if (expected == 0) continue;
        assert_true(eigen_residual(a, identity(50), some) < 1e-11);
        assert_true(distance_from_identity(some.vectors, some.vectors) < 1e-11);
    }
    assert_int_equal(plm::symmetric_eigen_below(Matrix(3, 3), -1.0).values.size(), 0); // the zero matrix
    assert_int_equal(plm::symmetric_eigen_below(Matrix(3, 3), 0.0).values.size(), 3);
}

void general_eigenpairs_are_b_orthonormal(void **) {
    const Matrix a = random_symmetric(30, 5), b = random_spd(30, 6);
    const auto e = plm::symmetric_eigen_general(a, b);
    assert_true(eigen_residual(a, b, e) < 1e-11);
    assert_true(distance_from_identity(e.vectors, plm::product('N', 'N', b, e.vectors)) < 1e-11);
    Matrix indefinite = b;
    indefinite(7, 7) = -1;
    const auto o = outcome_of([&] { plm::symmetric_eigen_general(a, indefinite); });
    assert_int_equal(o.status, plm::status::not_positive_definite);
    assert_int_equal(o.reason, plm::reason::not_positive_definite);
    assert_int_equal(o.index, 7);
}

void svd_reproduces_tall_wide_and_empty(void **) {
    for (const auto &shape : {std::pair<int, int>{30, 12}, {12, 30}, {1, 1}, {0, 4}}) {
        const Matrix a = random_matrix(shape.first, shape.second, 7);
        const auto s = plm::thin_svd(a);
        Matrix us = s.u;
        for (std::int64_t j = 0; j < us.cols(); ++j)
            for (std::int64_t i = 0; i < us.rows(); ++i) us(i, j) *= s.values[j];
        assert_true(max_difference(plm::product('N', 'N', us, s.vt), a) < 1e-13);
        assert_true(std::is_sorted(s.values.rbegin(), s.values.rend()));
    }
}

void least_squares_residual_is_orthogonal_to_the_columns(void **) {
    const Matrix a = random_matrix(40, 6, 8), b = random_matrix(40, 3, 9);
    Matrix r = b;
    plm::gemm('N', 'N', -1, a, plm::least_squares(a, b), 1, r);
    assert_true(max_abs(plm::product('T', 'N', a, r)) < 1e-12);
}

void nan_and_inf_are_refused_before_lapack(void **) {
    for (double bad : {std::nan(""), HUGE_VAL}) {
        Matrix a = random_spd(9, 10);
        a(5, 3) = a(3, 5) = bad;
        const Matrix good = random_spd(9, 11);
        const int status[] = {
            outcome_of([&] { plm::symmetric_eigen(a); }).status,
            outcome_of([&] { plm::symmetric_eigen_below(a, 0); }).status,
            outcome_of([&] { plm::symmetric_eigen_general(good, a); }).status,
            outcome_of([&] { plm::thin_svd(a); }).status,
            outcome_of([&] { plm::least_squares(good, a); }).status,
            outcome_of([&] {
                Matrix t = a;
                plm::RealLu().factor(t);
            }).status,
            outcome_of([&] {
                Matrix t = a;
                plm::DenseCholesky().factor(t);
            }).status,
            outcome_of([&] {
                vector<std::complex<double>> t(4, {1, bad});
                plm::ComplexLu().factor(2, t);
            }).status,
        };
        for (int s : status) assert_int_equal(s, plm::status::matrix);
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(products_agree_for_all_transposes),
        cmocka_unit_test(wrong_shapes_never_reach_blas),
        cmocka_unit_test(append_and_columns_keep_the_data),
        cmocka_unit_test(symmetric_eigenpairs_reproduce_the_matrix),
        cmocka_unit_test(eigenpairs_below_a_bound_are_those_of_the_full_problem),
        cmocka_unit_test(general_eigenpairs_are_b_orthonormal),
        cmocka_unit_test(svd_reproduces_tall_wide_and_empty),
        cmocka_unit_test(least_squares_residual_is_orthogonal_to_the_columns),
        cmocka_unit_test(nan_and_inf_are_refused_before_lapack),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
