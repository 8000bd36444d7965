// LU and Cholesky of dense matrices.
#include "linalg/error.hpp"
#include "linalg/lapack.hpp"
#include "linalg/work.hpp"
#include "support.hpp"

using namespace test;

namespace {

double lu_error(std::int64_t n) {
    const Matrix a = random_matrix(n, n, 1), x = random_matrix(n, 3, 2);
    Matrix b = plm::product('N', 'N', a, x), work = a;
    plm::RealLu lu;
    lu.factor(work);
    lu.solve(b.data(), 3, n);
    return max_difference(b, x) * lu.reciprocal_condition();
}

void lu_solves_to_rounding_at_all_sizes(void **) {
    for (std::int64_t n : {1, 2, 50, 110, 264, 462, 1000}) assert_true(lu_error(n) < 1e-13);
}

/// Counts what it hears, and asks to stop at the k-th time.
struct Listener final : plm::WorkListener {
    int heard = 0, stop_at = 0;
    bool goes_on() override { return ++heard == stop_at; }
};
/// PLM_OK or the status of what was thrown.
int status_of_lu(std::int64_t n, Listener &listener) {
    const plm::WorkScope scope(&listener);
    Matrix a = random_matrix(n, n, 1);
    plm::RealLu lu;
    try {
        lu.factor(a);
    } catch (const plm::Error &e) {
        return e.status();
    }
    return plm::status::ok;
}

// 2400^3 2/3 = 9.2e9 flops, which count for an eighth, in pieces of 3e8.
void a_large_factorization_is_heard_of_and_can_be_stopped(void **) {
    Listener all, none, stopped;
    stopped.stop_at = 2;
    assert_int_equal(status_of_lu(100, none), plm::status::ok);
    assert_int_equal(none.heard, 0);
    assert_int_equal(status_of_lu(2400, all), plm::status::ok);
    assert_in_range(all.heard, 3, 6);
    assert_int_equal(status_of_lu(2400, stopped), plm::status::cancelled);
    assert_int_equal(stopped.heard, 2);
}

/// Sign of det of a permutation times a diagonal.
int sign_of(std::initializer_list<int> permutation, std::initializer_list<double> entries) {
    const auto n = static_cast<std::int64_t>(permutation.size());
    Matrix a(n, n);
    for (std::int64_t j = 0; j < n; ++j) a(permutation.begin()[j], j) = entries.begin()[j];
    plm::RealLu lu;
    lu.factor(a);
    return lu.determinant_sign();
}

void determinant_sign_counts_swaps_and_signs(void **) {
    assert_int_equal(sign_of({0, 1, 2}, {1, 2, 3}), 1);
    assert_int_equal(sign_of({1, 0, 2}, {1, 2, 3}), -1);
    assert_int_equal(sign_of({1, 2, 0}, {1, 2, 3}), 1);
    assert_int_equal(sign_of({1, 2, 0}, {1, -2, 3}), -1);
}

void a_singular_pivot_is_replaced_and_reported(void **) {
    Matrix a(3, 3); // rank 2: the null vector is e_2
    a(0, 0) = 4;
    a(2, 2) = -2;
    plm::RealLu lu;
    lu.factor(a);
    double x[3] = {4, 1, 2};
    lu.solve(x, 1, 3);
    assert_true(lu.singular());
    assert_true(lu.reciprocal_condition() == 0);
    assert_true(x[0] == 1 && x[2] == -1 && std::isfinite(x[1]) && std::fabs(x[1]) > 1e14);
    Matrix zero(2, 2), good = random_matrix(2, 2, 5);
    lu.factor(zero);
    assert_true(lu.singular());
    lu.factor(good);
    assert_false(lu.singular());
}

void reciprocal_condition_sees_a_near_singularity(void **) {
    Matrix a(2, 2);
    a(0, 0) = 1;
    a(1, 1) = 1e-10;
    plm::RealLu lu;
    lu.factor(a);
    assert_true(std::fabs(lu.reciprocal_condition() / 1e-10 - 1) < 1e-6);
}

void complex_lu_solves_and_refuses_singular_matrices(void **) {
    using complex = std::complex<double>;
    const std::int64_t n = 20;
    Random random(3);
    vector<complex> a(n * n), x(n), b(n);
    for (auto &v : a) v = {random(), random()};
    for (auto &v : x) v = {random(), random()};
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < n; ++i) b[i] += a[i + j * n] * x[j];
    plm::ComplexLu lu;
    lu.factor(n, a);
    lu.solve(b.data(), 1, n);
    double error = 0;
    for (std::int64_t i = 0; i < n; ++i) error = std::max(error, std::abs(b[i] - x[i]));
    assert_true(error < 1e-11);
    vector<complex> singular(4, complex(1, 1));
    const auto o = outcome_of([&] { lu.factor(2, singular); });
    assert_int_equal(o.status, plm::status::singular);
    assert_int_equal(o.index, 1);
}

void cholesky_solves_or_says_no(void **) {
    const Matrix k = random_definite_dense(20, 3), x = random_matrix(20, 2, 4);
    Matrix b = plm::product('N', 'N', k, x), work = k, negative = k;
    negative(13, 13) = -1;
    plm::DenseCholesky cholesky;
    assert_true(cholesky.factor(work));
    cholesky.solve(b.data(), 2, 20);
    assert_true(max_difference(b, x) < 1e-13);
    assert_false(cholesky.factor(negative));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(lu_solves_to_rounding_at_all_sizes),
        cmocka_unit_test(a_large_factorization_is_heard_of_and_can_be_stopped),
        cmocka_unit_test(determinant_sign_counts_swaps_and_signs),
        cmocka_unit_test(a_singular_pivot_is_replaced_and_reported),
        cmocka_unit_test(reciprocal_condition_sees_a_near_singularity),
        cmocka_unit_test(complex_lu_solves_and_refuses_singular_matrices),
        cmocka_unit_test(cholesky_solves_or_says_no),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
