// Factors whose numbers are kept in single precision: solves as good as in double, or an error.
#include "linalg/parallel.hpp"
#include "solids.hpp"
#include "structure/solver/make_factor.hpp"

using namespace test;

namespace {

plm::Solver single() {
    plm::Solver solver;
    solver.precision = plm::FactorPrecision::single;
    return solver;
}

void solves_are_those_of_double_precision(void **) {
    const SparseMatrix a = solid(9, 8, 7);
    const auto full = plm::make_factor(a), rounded = plm::make_factor(a, single());
    for (std::int64_t nrhs : {0, 1, 3, 64, 70}) {
        const Matrix b = random_matrix(a.cols, nrhs, 4);
        Matrix x = b, y = b;
        full->solve(x);
        rounded->solve(y);
        double largest = 0;
        for (std::int64_t k = 0; k < x.rows() * nrhs; ++k)
            largest = std::max(largest, std::fabs(x.data()[k]));
        assert_true(max_difference(x, y) <= 1e-11 * largest);
        assert_true(max_difference(plm::multiply(a, y), b) < 1e-11);
    }
    assert_true(std::fabs(rounded->reciprocal_condition() / full->reciprocal_condition() - 1) < 1e-6);
    assert_true(rounded->factor_nonzeros() >= full->factor_nonzeros());
}

void threads_do_not_change_a_digit(void **) {
    const SparseMatrix a = solid(12, 11, 10);
    const auto factor = plm::make_factor(a, single());
    const Matrix b = random_matrix(a.cols, 70, 5);
    Matrix alone = b;
    factor->solve(alone);
    for (std::int64_t threads : {2, 3}) {
        const plm::ThreadsScope scope(threads);
        Matrix x = b;
        factor->solve(x);
        assert_true(max_difference(x, alone) == 0);
    }
}

// Powers that single precision does not hold, in the matrix and in the right-hand side; zero stays zero.
void units_do_not_matter(void **) {
    for (double unit : {1e-90, 1e80}) {
        SparseMatrix a = solid(5, 5, 5);
        for (double &v : a.val) v *= unit;
        const auto factor = plm::make_factor(a, single());
        Matrix x(a.cols, 3);
        for (std::int64_t i = 0; i < a.cols; ++i) {
            x(i, 0) = 1e60;
            x(i, 1) = i % 2 ? 1e-60 : 0;
        }
        const Matrix b = x;
        factor->solve(x);
        const Matrix back = plm::multiply(a, x);
        for (std::int64_t i = 0; i < a.cols; ++i) {
            assert_true(std::fabs(back(i, 0) - 1e60) < 1e50);
            assert_true(std::fabs(back(i, 1) - b(i, 1)) < 1e-70);
            assert_true(x(i, 2) == 0);
        }
    }
}

void a_bad_pivot_is_named_by_its_dof(void **) {
    for (double pivot : {-1.0, 0.0}) {
        vector<double> d(60, 2.0);
        d[41] = pivot;
        const auto o = outcome_of([&] { plm::make_factor(diagonal(d), single()); });
        assert_int_equal(o.status, plm::status::not_positive_definite);
        assert_int_equal(o.index, 41);
    }
}

// Rounding of the factor is more than this matrix bears: an error says so, not a wrong solution.
void what_does_not_contract_is_an_error(void **) {
    SparseMatrix a = membrane(40, 40, false); // one rigid motion but for a soft spring
    a.val[a.ptr[0]] += 1e-12;
    const auto factor = plm::make_factor(a, single());
    Matrix x(a.cols, 1);
    for (std::int64_t i = 0; i < a.cols; ++i) x(i, 0) = 1;
    const auto o = outcome_of([&] { factor->solve(x); });
    assert_int_equal(o.status, plm::status::convergence);
    assert_int_equal(o.reason, plm::reason::no_contraction);
}

void solvers_without_it_refuse(void **) {
    plm::Solver eigen = plm::SolverName::eigen;
    eigen.precision = plm::FactorPrecision::single;
    const auto o = outcome_of([&] { plm::make_factor(membrane(3, 3), eigen); });
    assert_true(o.status == plm::status::argument || o.status == plm::status::not_built);
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solves_are_those_of_double_precision),
        cmocka_unit_test(threads_do_not_change_a_digit),
        cmocka_unit_test(units_do_not_matter),
        cmocka_unit_test(a_bad_pivot_is_named_by_its_dof),
        cmocka_unit_test(what_does_not_contract_is_an_error),
        cmocka_unit_test(solvers_without_it_refuse),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
