// Sparse factorizations, built in and the host's.
#include "linalg/lapack.hpp"
#include "linalg/parallel.hpp"
#include "matrices.hpp"
#include "structure/solver/make_factor.hpp"

using namespace test;

namespace {

/// |A X - B| / |B| after a solve with a padded leading dimension.
double solve_residual(const SparseMatrix &a, std::int64_t nrhs, const plm::Solver &solver = {}) {
    const std::int64_t n = a.cols, ld = n + 3;
    const Matrix b = random_matrix(n, nrhs, 1);
    Matrix padded(ld, nrhs), x(n, nrhs);
    for (std::int64_t j = 0; j < nrhs; ++j) std::copy_n(b.col(j), n, padded.col(j));
    const auto factor = plm::make_factor(a, solver);
    factor->solve(padded.data(), nrhs, ld);
    for (std::int64_t j = 0; j < nrhs; ++j) std::copy_n(padded.col(j), n, x.col(j));
    for (std::int64_t j = 0; j < nrhs; ++j)
        if (padded(n, j) != 0 || padded(n + 2, j) != 0) return INFINITY; // wrote into the padding
    return max_difference(plm::multiply(a, x), b);
}

void solves_leave_a_residual_of_rounding(void **) {
    const SparseMatrix a = membrane(30, 20), b = random_definite(300, 2);
    for (std::int64_t nrhs : {0, 1, 2, 9, 33, 70}) {
        assert_true(solve_residual(a, nrhs) < 1e-12);
        assert_true(solve_residual(b, nrhs) < 1e-12);
    }
}

/// Dense, positive definite but for the pivot of column `bad`; -1: none.
SparseMatrix dense_matrix(std::int64_t n, std::int64_t bad) {
    const Matrix k = random_definite_dense(n, 5);
    vector<std::int64_t> i, j;
    vector<double> v;
    for (std::int64_t c = 0; c < n; ++c)
        for (std::int64_t r = 0; r < n; ++r)
            i.push_back(r), j.push_back(c), v.push_back(r == c && r == bad ? -k(r, c) : k(r, c));
    return plm::from_triplets(n, n, i, j, v);
}

// A matrix that stores every entry, as those of superelements do, goes to LAPACK, unless a solver is named.
void dense_matrices_are_factored_as_such(void **) {
    const SparseMatrix a = dense_matrix(100, -1);
    for (std::int64_t nrhs : {1, 40}) assert_true(solve_residual(a, nrhs) < 1e-10);
    const auto factor = plm::make_factor(a);
    assert_int_equal(factor->factor_nonzeros(), 100 * 101 / 2);
    assert_true(factor->reciprocal_condition() > 1e-8 && factor->reciprocal_condition() < 1);
    const auto o = outcome_of([] { plm::make_factor(dense_matrix(100, 70)); });
    assert_int_equal(o.status, plm::status::not_positive_definite);
    assert_int_equal(o.index, 70);
    assert_int_equal(plm::count_negative(dense_matrix(100, 70)), 1);
}

// The library's own by name: each that was built serves, the others say so, and the host's needs a host.
void solvers_are_chosen_by_name(void **) {
    const SparseMatrix a = membrane(30, 20);
    int served = 0;
    for (plm::SolverName name : {plm::SolverName::cholmod, plm::SolverName::eigen}) {
        double residual = INFINITY;
        const auto o = outcome_of([&] { residual = solve_residual(a, 3, name); });
        assert_true(o.status == plm::status::ok ? residual < 1e-12 : o.status == plm::status::not_built);
        served += o.status == plm::status::ok;
    }
    assert_in_range(served, 1, 2);
    const auto none = outcome_of([&] { plm::count_negative(a, plm::SolverName::host); });
    assert_int_equal(none.status, plm::status::state);
}

void one_factor_serves_blocks_and_single_solves_alike(void **) {
    const auto factor = plm::make_factor(membrane(15, 15));
    const Matrix b = random_matrix(225, 40, 3);
    Matrix block = b;
    factor->solve(block);
    double largest = 0;
    for (std::int64_t j : {0, 31, 32, 39}) {
        Matrix x = b.columns(j, 1);
        factor->solve(x);
        largest = std::max(largest, max_difference(x, block.columns(j, 1)));
    }
    assert_true(largest < 1e-13);
    assert_true(factor->factor_nonzeros() > 225);
}

// Solutions and products are shared out by columns: to the last bit as one thread has them.
void threads_do_not_change_a_digit(void **) {
    const SparseMatrix a = membrane(180, 160); // its products are worth a thread
    const auto factor = plm::make_factor(a);
    const Matrix b = random_matrix(a.cols, 75, 8);
    Matrix solution, once, back;
    for (std::int64_t threads : {1, 2, 3}) {
        const plm::ThreadsScope scope(threads);
        Matrix x = b;
        factor->solve(x);
        const Matrix y = plm::multiply(a, b), z = plm::multiply_transposed(a, b);
        if (threads == 1) solution = x, once = y, back = z;
        assert_true(max_difference(x, solution) == 0);
        assert_true(max_difference(y, once) == 0);
        assert_true(max_difference(z, back) == 0);
    }
    assert_true(max_difference(plm::multiply(a, solution), b) < 1e-10);
}

void inertia_counts_the_eigenvalues_below_the_shift(void **) {
    const SparseMatrix k = membrane(9, 7);
    const auto e = plm::symmetric_eigen(plm::to_dense(k));
    for (double shift : {-0.5, 0.3, 1.01, 2.2, 3.7, 5.3, 9.0}) {
        const SparseMatrix a = plm::add(1, k, -shift, diagonal(vector<double>(63, 1.0)));
        const auto expected = std::lower_bound(e.values.begin(), e.values.end(), shift) - e.values.begin();
        assert_int_equal(plm::count_negative(a), expected);
    }
}

void the_index_of_a_bad_pivot_is_the_callers(void **) {
    // One negative (zero) entry decoupled from the rest: whatever the ordering, only it can fail.
    for (std::int64_t bad : {0, 17, 199}) {
        SparseMatrix k = membrane(20, 10);
        for (std::int64_t j = 0; j < k.cols; ++j)
            for (std::int64_t p = k.ptr[j]; p < k.ptr[j + 1]; ++p)
                if (j == bad || k.idx[p] == bad) k.val[p] = k.idx[p] == j ? -1 : 0;
        const auto negative = outcome_of([&] { plm::make_factor(k); });
        assert_int_equal(negative.status, plm::status::not_positive_definite);
        assert_int_equal(negative.reason, plm::reason::not_positive_definite);
        assert_int_equal(negative.index, bad);
        assert_int_equal(plm::count_negative(k), 1);
        for (std::int64_t p = k.ptr[bad]; p < k.ptr[bad + 1]; ++p) k.val[p] = 0;
        const auto zero = outcome_of([&] { plm::count_negative(k); });
        assert_int_equal(zero.status, plm::status::singular);
        assert_int_equal(zero.reason, plm::reason::singular);
        assert_int_equal(zero.index, bad);
        const auto semi = outcome_of([&] { plm::make_factor(k); });
        assert_int_equal(semi.status, plm::status::not_positive_definite);
        assert_int_equal(semi.index, bad);
    }
}

void a_nearly_singular_matrix_shows_in_the_condition(void **) {
    vector<double> d(50, 1.0);
    d[20] = 1e-13;
    const auto bad = plm::make_factor(diagonal(d));
    const auto good = plm::make_factor(membrane(10, 5));
    assert_true(bad->reciprocal_condition() < 1e-12);
    assert_true(good->reciprocal_condition() > 1e-2);
}

void nan_is_refused_with_its_column(void **) {
    SparseMatrix k = membrane(5, 5);
    k.val[k.ptr[7]] = std::nan("");
    const auto o = outcome_of([&] { plm::make_factor(k); });
    assert_int_equal(o.status, plm::status::matrix);
    assert_int_equal(o.index, 7);
}

/// METIS would fail this: it re-seeds rand() (and takes over SIGTERM while it runs).
void the_hosts_random_numbers_are_left_alone(void **) {
    const SparseMatrix k = membrane(100, 100);
    std::srand(7);
    std::rand();
    const int expected = std::rand();
    std::srand(7);
    std::rand();
    plm::make_factor(k);
    assert_int_equal(std::rand(), expected);
}

void an_empty_matrix_is_no_problem(void **) {
    const SparseMatrix none = plm::from_triplets(0, 0, {}, {}, {});
    const auto o = outcome_of([&] { plm::make_factor(none)->solve(nullptr, 1, 1); });
    assert_int_equal(o.status, plm::status::ok);
}

// --- a host solver: dense LU of the triangle it is given

struct Host {
    int factored = 0, solved = 0, released = 0, definite = -1;
    int fail_factor = 0, fail_solve = 0;
    bool lower = true, poison = false;
    plm::RealLu lu;
};

int host_factor(std::int64_t n, const std::int64_t *ptr, const std::int64_t *row, const double *val,
                int definite, void **handle, void *user) {
    auto &h = *static_cast<Host *>(user);
    h.definite = definite;
    if (h.fail_factor) return h.fail_factor;
    Matrix a(n, n);
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t p = ptr[j]; p < ptr[j + 1]; ++p) {
            h.lower = h.lower && row[p] >= j;
            a(row[p], j) = a(j, row[p]) = val[p];
        }
    h.lu.factor(a);
    ++h.factored;
    *handle = user;
    return 0;
}
int host_solve(void *handle, std::int64_t nrhs, double *x, std::int64_t ldx, void *) {
    auto &h = *static_cast<Host *>(handle);
    if (h.fail_solve) return h.fail_solve;
    h.lu.solve(x, nrhs, ldx);
    if (h.poison) x[0] = std::nan("");
    ++h.solved;
    return 0;
}
void host_release(void *handle, void *) {
    ++static_cast<Host *>(handle)->released;
}
plm::HostSolver solver(Host &h) {
    return {host_factor, host_solve, host_release, &h};
}

void the_hosts_solver_is_used_and_released(void **) {
    Host h;
    const auto s = solver(h);
    const double residual = solve_residual(membrane(6, 5), 4, &s);
    assert_true(residual < 1e-13);
    assert_true(h.lower);
    assert_int_equal(h.definite, 1);
    assert_int_equal(h.factored, 1);
    assert_int_equal(h.solved, 1);
    assert_int_equal(h.released, 1);
}

void the_hosts_failures_are_reported_with_their_code(void **) {
    const SparseMatrix k = membrane(6, 5);
    Host h;
    const auto s = solver(h);
    h.fail_factor = 42;
    const auto factor = outcome_of([&] { plm::count_negative(k, &s); });
    assert_int_equal(factor.status, plm::status::callback);
    assert_int_equal(factor.code, 42);
    assert_int_equal(h.released, 0);
    h.fail_factor = 0;
    h.fail_solve = -7;
    const auto solve = outcome_of([&] { solve_residual(k, 1, &s); });
    assert_int_equal(solve.status, plm::status::callback);
    assert_int_equal(solve.code, -7);
    h.fail_solve = 0;
    h.poison = true;
    const auto nan = outcome_of([&] { solve_residual(k, 1, &s); });
    assert_int_equal(nan.status, plm::status::callback);
    assert_int_equal(h.released, h.factored);
    const plm::HostSolver incomplete;
    const auto none = outcome_of([&] { plm::count_negative(k, &incomplete); });
    assert_int_equal(none.status, plm::status::argument);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(solves_leave_a_residual_of_rounding),
        cmocka_unit_test(dense_matrices_are_factored_as_such),
        cmocka_unit_test(solvers_are_chosen_by_name),
        cmocka_unit_test(one_factor_serves_blocks_and_single_solves_alike),
        cmocka_unit_test(threads_do_not_change_a_digit),
        cmocka_unit_test(inertia_counts_the_eigenvalues_below_the_shift),
        cmocka_unit_test(the_index_of_a_bad_pivot_is_the_callers),
        cmocka_unit_test(a_nearly_singular_matrix_shows_in_the_condition),
        cmocka_unit_test(nan_is_refused_with_its_column),
        cmocka_unit_test(the_hosts_random_numbers_are_left_alone),
        cmocka_unit_test(an_empty_matrix_is_no_problem),
        cmocka_unit_test(the_hosts_solver_is_used_and_released),
        cmocka_unit_test(the_hosts_failures_are_reported_with_their_code),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
