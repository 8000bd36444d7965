// The factorization that large matrices get, front by front on several threads: right, with the same digits
// for any number of threads, and with the errors of any other.
#include "linalg/parallel.hpp"
#include "solids.hpp"
#include "structure/solver/make_factor.hpp"

using namespace test;

namespace {

/// Large enough for it: 1e9 flops and more, fronts of several strips.
const SparseMatrix &large_solid() {
    static const SparseMatrix a = solid(17, 15, 15);
    return a;
}

void it_is_large_enough(void **) {
    assert_true(plm::estimate_factor(large_solid(), plm::SolverName::cholmod)->flops > 1e9);
}

void solutions_leave_no_residual(void **) {
    const SparseMatrix &a = large_solid();
    const auto factor = plm::make_factor(a, plm::SolverName::cholmod);
    for (std::int64_t nrhs : {0, 1, 2, 8, 64, 70}) {
        const Matrix b = random_matrix(a.cols, nrhs, 4);
        Matrix x = b;
        factor->solve(x);
        assert_true(max_difference(plm::multiply(a, x), b) < 1e-11);
    }
}

// Columns of a larger array, whatever stands between them.
void the_leading_dimension_counts(void **) {
    const SparseMatrix &a = large_solid();
    const auto factor = plm::make_factor(a, plm::SolverName::cholmod);
    Matrix x = random_matrix(a.cols, 3, 5), wide(a.cols + 7, 3);
    for (std::int64_t j = 0; j < 3; ++j) std::copy_n(x.col(j), a.cols, wide.col(j));
    factor->solve(wide.data(), 3, wide.rows());
    factor->solve(x);
    for (std::int64_t j = 0; j < 3; ++j) {
        assert_memory_equal(x.col(j), wide.col(j), sizeof(double) * static_cast<std::size_t>(a.cols));
        for (std::int64_t i = a.cols; i < wide.rows(); ++i) assert_true(wide(i, j) == 0);
    }
}

struct Digits {
    Matrix one, block, product;
    std::int64_t negative;
};
Digits digits_with(std::int64_t threads) {
    const plm::ThreadsScope scope(threads);
    const SparseMatrix &a = large_solid();
    const auto factor = plm::make_factor(a, plm::SolverName::cholmod);
    Digits d{random_matrix(a.cols, 1, 6), random_matrix(a.cols, 33, 7), {}, 0};
    factor->solve(d.one);
    factor->solve(d.block);
    d.product = plm::product('T', 'N', d.block, plm::multiply_transposed(a, d.block));
    SparseMatrix shifted = a;
    for (std::int64_t j = 0; j < a.cols; ++j)
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p)
            if (a.idx[p] == j) shifted.val[p] -= 0.5;
    d.negative = plm::count_negative(shifted, plm::SolverName::cholmod);
    return d;
}

void threads_do_not_change_a_digit(void **) {
    const Digits alone = digits_with(1);
    assert_true(alone.negative > 0);
    for (std::int64_t threads : {2, 3, 5}) {
        const Digits d = digits_with(threads);
        assert_true(max_difference(d.one, alone.one) == 0);
        assert_true(max_difference(d.block, alone.block) == 0);
        assert_true(max_difference(d.product, alone.product) == 0);
        assert_int_equal(d.negative, alone.negative);
    }
}

void threads_may_solve_at_once(void **) {
    const SparseMatrix &a = large_solid();
    const auto factor = plm::make_factor(a, plm::SolverName::cholmod);
    const Matrix b = random_matrix(a.cols, 4, 8);
    Matrix expected = b;
    for (std::int64_t j = 0; j < 4; ++j) factor->solve(expected.col(j), 1, a.cols);
    Matrix x = b;
    const plm::ThreadsScope scope(4);
    plm::parallel_for(4, [&](std::int64_t j) { factor->solve(x.col(j), 1, a.cols); });
    assert_true(max_difference(x, expected) == 0);
}

/// A few entries in each column, one column with all of them.
SparseMatrix sparse_forces(std::int64_t n) {
    Random random(11);
    vector<std::int64_t> i, j;
    vector<double> v;
    const auto put = [&](std::int64_t row, std::int64_t column) {
        i.push_back(row);
        j.push_back(column);
        v.push_back(random());
    };
    for (std::int64_t c = 0; c < 69; ++c) {
        put(97 * c % n, c);
        put((5003 + 31 * c) % n, c);
    }
    for (std::int64_t row = 0; row < n; ++row) put(row, 69);
    return plm::from_triplets(n, 70, i, j, v);
}

double largest(const Matrix &a) {
    double most = 0;
    for (std::int64_t k = 0; k < a.rows() * a.cols(); ++k) most = std::max(most, std::fabs(a.data()[k]));
    return most;
}

// Against the responses themselves, and with the same digits for any number of threads.
void products_of_responses_need_no_responses(void **) {
    const SparseMatrix &a = large_solid(), f = sparse_forces(a.cols);
    SparseMatrix m = a;
    for (double &v : m.val) v *= v;
    const auto factor = plm::make_factor(a, plm::SolverName::cholmod);
    const Matrix loads = plm::to_dense(f);
    Matrix x = loads;
    factor->solve(x);
    const Matrix energy = plm::product('T', 'N', loads, x),
                 inertia = plm::product('T', 'N', x, plm::multiply(m, x));
    Matrix first_energy, first_inertia;
    for (std::int64_t threads : {1, 2, 5}) {
        const plm::ThreadsScope scope(threads);
        Matrix e, i;
        assert_true(factor->multiply_responses(f, m, e, i));
        assert_true(max_difference(e, energy) < 1e-13 * largest(energy));
        assert_true(max_difference(i, inertia) < 1e-13 * largest(inertia));
        if (threads == 1) first_energy = e, first_inertia = i;
        assert_true(max_difference(e, first_energy) == 0 && max_difference(i, first_inertia) == 0);
    }
}

// Rows far apart that a mass couples and the stiffness does not.
void products_refuse_what_is_coupled_otherwise(void **) {
    const SparseMatrix &a = large_solid();
    const SparseMatrix far = plm::from_triplets(a.cols, a.cols, {0, a.cols - 1}, {a.cols - 1, 0}, {1, 1});
    const auto factor = plm::make_factor(a, plm::SolverName::cholmod);
    Matrix e, i;
    assert_false(factor->multiply_responses(sparse_forces(a.cols), plm::add(1, a, 1, far), e, i));
    assert_true(e.empty() && i.empty());
}

void a_bad_pivot_is_named_by_its_dof(void **) {
    for (double pivot : {-1.0, 0.0})
        for (std::int64_t threads : {1, 3}) {
            const plm::ThreadsScope scope(threads);
            SparseMatrix a = large_solid();
            const std::int64_t dof = 3001; // on its own
            for (std::int64_t j = 0; j < a.cols; ++j)
                for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p)
                    if (a.idx[p] == dof || j == dof) a.val[p] = a.idx[p] == j ? pivot : 0;
            const auto o = outcome_of([&] { plm::make_factor(a, plm::SolverName::cholmod); });
            assert_int_equal(o.status, plm::status::not_positive_definite);
            assert_int_equal(o.index, dof);
        }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(it_is_large_enough),
        cmocka_unit_test(solutions_leave_no_residual),
        cmocka_unit_test(the_leading_dimension_counts),
        cmocka_unit_test(threads_do_not_change_a_digit),
        cmocka_unit_test(threads_may_solve_at_once),
        cmocka_unit_test(products_of_responses_need_no_responses),
        cmocka_unit_test(products_refuse_what_is_coupled_otherwise),
        cmocka_unit_test(a_bad_pivot_is_named_by_its_dof),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
