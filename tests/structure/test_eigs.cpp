// Lowest eigenpairs against dense solutions and closed forms.
#include "linalg/lapack.hpp"
#include "matrices.hpp"
#include "structure/eigs.hpp"
#include "structure/eigs_internal.hpp"
#include "structure/solver/make_factor.hpp"

using namespace test;

namespace {

constexpr double pi = 3.141592653589793238463;

plm::EigenPairs lowest(const SparseMatrix &k, const SparseMatrix &m, double shift, std::int64_t n) {
    const auto factor = plm::make_factor(plm::add(1, k, -shift, m));
    return plm::lowest_eigenpairs(k, m, *factor, shift, n);
}

SparseMatrix unit_mass(std::int64_t n) {
    return diagonal(vector<double>(n, 1.0));
}

/// Largest relative difference of eigenvalues, relative residual of the vectors, and loss of
/// M-orthonormality.
double worst_error(const SparseMatrix &k, const SparseMatrix &m, const plm::EigenPairs &e,
                   const vector<double> &exact) {
    const auto count = static_cast<std::int64_t>(e.values.size());
    if (e.vectors.cols() != count || count > static_cast<std::int64_t>(exact.size())) return INFINITY;
    const Matrix kx = plm::multiply(k, e.vectors.in_core()), mx = plm::multiply(m, e.vectors.in_core());
    double worst = distance_from_identity(e.vectors.in_core(), mx);
    for (std::int64_t j = 0; j < count; ++j) {
        worst = std::max(worst, std::fabs(e.values[j] - exact[j]) / std::max(1e-3, std::fabs(exact[j])));
        double r = 0;
        for (std::int64_t i = 0; i < k.cols; ++i)
            r = std::max(r, std::fabs(kx(i, j) - e.values[j] * mx(i, j)));
        worst = std::max(worst, r / plm::norm_inf(k));
    }
    return worst;
}

/// Eigenvalues of the five-point membrane with unit masses, ascending.
vector<double> membrane_values(std::int64_t nx, std::int64_t ny, bool fixed = true) {
    vector<double> values;
    const auto one = [fixed](std::int64_t i, std::int64_t n) {
        const double angle = fixed ? pi * static_cast<double>(i + 1) / static_cast<double>(n + 1)
                                   : pi * static_cast<double>(i) / static_cast<double>(n);
        return 2 - 2 * std::cos(angle);
    };
    for (std::int64_t i = 0; i < nx; ++i)
        for (std::int64_t j = 0; j < ny; ++j) values.push_back(one(i, nx) + one(j, ny));
    std::sort(values.begin(), values.end());
    return values;
}

// A free chain, all its pairs from a shift just below zero: their compliances differ by 1e13, and the high
// ones come mixed with one another.
void pairs_far_from_a_shift_beside_zero_are_told_apart(void **) {
    const std::int64_t n = 9;
    const SparseMatrix k = membrane(n, 1, false), m = unit_mass(n);
    const plm::EigenPairs all = lowest(k, m, -3e-13, n);
    assert_true(worst_error(k, m, all, membrane_values(n, 1, false)) <
                1e-6); // the residual that is asked for
}

void lanczos_agrees_with_lapack_on_random_pencils(void **) {
    for (std::uint64_t seed : {1, 2, 3}) {
        const std::int64_t n = 300;
        const SparseMatrix k = random_definite(n, seed), m = random_definite(n, seed + 100);
        const auto exact = plm::symmetric_eigen_general(plm::to_dense(k), plm::to_dense(m));
        for (std::int64_t count : {1, 5, 40}) {
            const auto e = lowest(k, m, 0, count);
            assert_int_equal(e.values.size(), count);
            assert_true(worst_error(k, m, e, exact.values) < 1e-10);
        }
    }
}

/// The two methods for the same pencils, each alone, against the closed form.
void arpack_and_lanczos_agree(void **) {
    for (std::int64_t n : {15, 40}) {
        const SparseMatrix k = membrane(n, n - 1), m = unit_mass(n * (n - 1));
        const auto factor = plm::make_factor(k);
        const plm::EigsOptions options;
        const auto stiffness = plm::tall_matrix(k), mass = plm::tall_matrix(m);
        const auto behind = plm::tall_factor(*factor);
        const plm::Pencil pencil{*stiffness, *mass, *behind, 0, options, mass->n_positive(), mass->none()};
        const plm::KrylovRequest request{6, 26, 0, 300, 1};
        for (const auto &run : {plm::run_arpack, plm::run_lanczos}) {
            plm::KrylovResult result = run(pencil, request);
            std::sort(result.pairs.values.begin(), result.pairs.values.end());
            assert_true(result.end == plm::KrylovEnd::converged);
            assert_int_equal(result.pairs.values.size(), 6);
            const vector<double> exact = membrane_values(n, n - 1);
            for (int j = 0; j < 6; ++j) assert_true(std::fabs(result.pairs.values[j] / exact[j] - 1) < 1e-11);
        }
    }
}

// A membrane with a penalty of 1e13 between two nodes: beside that a vector that holds a ten-thousandth of
// another mode misses the equation by nothing, but not in the rows that the penalty does not touch.
void a_vector_that_is_off_is_mended_beside_penalties(void **) {
    constexpr std::int64_t nx = 17, ny = 30, one = 3 * nx + 4, other = 20 * nx + 11;
    constexpr double penalty = 1e13;
    const SparseMatrix ties =
        plm::from_triplets(nx * ny, nx * ny, {one, other, one, other}, {one, other, other, one},
                           {penalty, penalty, -penalty, -penalty});
    const SparseMatrix k = plm::add(1, membrane(nx, ny), 1, ties), m = unit_mass(nx * ny);
    const auto factor = plm::make_factor(k);
    plm::EigenPairs whole = plm::lowest_eigenpairs(k, m, *factor, 0, 12),
                    off = plm::lowest_eigenpairs(k, m, *factor, 0, 6);
    for (std::int64_t i = 0; i < k.cols; ++i) off.vectors.in_core()(i, 3) += 1e-4 * whole.vectors.at(i, 10);
    off.values[3] += 1e-8 * whole.values[10];
    plm::EigsOptions options;
    options.known = {&off.values, &off.vectors, nullptr};
    const auto e = plm::lowest_eigenpairs(k, m, *factor, 0, 6, options);
    double along = 0;
    for (std::int64_t i = 0; i < k.cols; ++i) along += e.vectors.at(i, 3) * whole.vectors.at(i, 10);
    // the penalty's rounding allows 6e-6 of it; the value was off by 2e-8
    assert_true(std::fabs(along) < 1e-5);
    assert_true(std::fabs(e.values[3] / whole.values[3] - 1) < 1e-9);
}

// A chain held at both ends whose middle mass is two halves, tied by a spring 2^28 times as stiff as the
// others, so that no entry is rounded: its eigenvalues are those of the chain with one mass there to 1e-11.
// Rounding of the factor and of K x changes them by 1e-6.
void eigenvalues_beside_penalties_keep_their_digits(void **) {
    constexpr std::int64_t n = 401, middle = n / 2;
    const double penalty = std::ldexp(1.0, 28);
    vector<std::int64_t> i, j;
    vector<double> v, mass(n + 1, 1.0);
    const auto spring = [&](std::int64_t a, std::int64_t b, double k) {
        i.insert(i.end(), {a, b, a, b}), j.insert(j.end(), {a, b, b, a}), v.insert(v.end(), {k, k, -k, -k});
    };
    for (std::int64_t a = 0; a < n; ++a)
        if (a != middle) spring(a, a + 1, 1);
    spring(middle, middle + 1, penalty);
    mass[middle] = mass[middle + 1] = 0.5;
    for (std::int64_t end : {std::int64_t{0}, n}) i.push_back(end), j.push_back(end), v.push_back(1);
    const auto e = lowest(plm::from_triplets(n + 1, n + 1, i, j, v), diagonal(mass), 0, 8);
    for (int mode = 0; mode < 8; ++mode) {
        const double exact = 2 - 2 * std::cos(pi * (mode + 1) / (n + 1));
        assert_true(std::fabs(e.values[mode] / exact - 1) < 1e-9);
    }
}

void double_eigenvalues_of_a_square_membrane_come_in_pairs(void **) {
    for (std::int64_t n : {12, 40}) {
        const SparseMatrix k = membrane(n, n), m = unit_mass(n * n);
        for (std::int64_t count : {2, 3, 8, 30}) {
            const auto e = lowest(k, m, 0, count);
            assert_int_equal(e.values.size(), count);
            assert_true(worst_error(k, m, e, membrane_values(n, n)) < 1e-10);
        }
    }
}

/// With a loose tolerance a Lanczos process converges before its rounding errors show it the second copies:
/// six values requested from it alone end with one that is 30 % too high.
void a_copy_that_lanczos_misses_is_put_in(void **) {
    for (std::int64_t n : {20, 40}) {
        const SparseMatrix k = membrane(n, n), m = unit_mass(n * n);
        const vector<double> exact = membrane_values(n, n);
        const auto factor = plm::make_factor(k);
        plm::EigsOptions options;
        for (double tolerance : {1e-8, 1e-6, 1e-4}) {
            options.tolerance = tolerance;
            const auto e = plm::lowest_eigenpairs(k, m, *factor, 0, 6, options);
            for (int j = 0; j < 6; ++j) assert_true(std::fabs(e.values[j] / exact[j] - 1) < 10 * tolerance);
        }
    }
}

void many_equal_copies_are_all_found(void **) {
    // Ten identical, uncoupled strings: every eigenvalue is tenfold.
    const std::int64_t copies = 10, length = 12, n = copies * length;
    vector<std::int64_t> i, j;
    vector<double> v, exact;
    for (std::int64_t a = 0; a < n; ++a) {
        i.push_back(a), j.push_back(a), v.push_back(2);
        if (a % length == 0) continue;
        i.push_back(a), j.push_back(a - 1), v.push_back(-1);
        i.push_back(a - 1), j.push_back(a), v.push_back(-1);
    }
    for (std::int64_t s = 1; s <= length; ++s)
        exact.insert(exact.end(), copies,
                     2 - 2 * std::cos(pi * static_cast<double>(s) / static_cast<double>(length + 1)));
    const SparseMatrix k = plm::from_triplets(n, n, i, j, v), m = unit_mass(n);
    const auto e = lowest(k, m, 0, 24);
    assert_int_equal(e.values.size(), 24);
    assert_true(worst_error(k, m, e, exact) < 1e-10);
}

void rigid_modes_are_found_with_a_negative_shift(void **) {
    for (std::int64_t n : {6, 25}) { // dense and Lanczos
        const SparseMatrix k = membrane(n, n, false), m = unit_mass(n * n);
        const auto e = lowest(k, m, -0.01, 9);
        assert_true(std::fabs(e.values[0]) < 1e-12);
        assert_true(worst_error(k, m, e, membrane_values(n, n, false)) < 1e-9);
    }
}

/// Condensing the mass-less DOFs leaves the finite eigenvalues.
vector<double> condensed_values(const SparseMatrix &k, const vector<double> &mass) {
    plm::DenseCholesky cholesky;
    Matrix a = plm::to_dense(k), flexibility(k.cols, k.cols);
    for (std::int64_t i = 0; i < k.cols; ++i) flexibility(i, i) = 1;
    cholesky.factor(a);
    cholesky.solve(flexibility.data(), k.cols, k.cols);
    for (std::int64_t j = 0; j < k.cols; ++j)
        for (std::int64_t i = 0; i < k.cols; ++i) flexibility(i, j) *= std::sqrt(mass[i] * mass[j]);
    const auto e = plm::symmetric_eigen(flexibility);
    vector<double> values;
    for (auto theta = e.values.rbegin(); theta != e.values.rend() && *theta > 1e-13; ++theta)
        values.push_back(1 / *theta);
    return values;
}

void massless_dofs_carry_no_mode(void **) {
    for (std::int64_t n : {7, 18}) { // dense and Lanczos
        const SparseMatrix k = membrane(n, n);
        vector<double> mass(n * n);
        for (std::int64_t i = 0; i < n * n; ++i)
            mass[i] = i % 3 == 0 ? 0 : 1 + 0.1 * static_cast<double>(i % 7);
        const SparseMatrix m = diagonal(mass);
        const auto exact = condensed_values(k, mass);
        assert_true(worst_error(k, m, lowest(k, m, 0, 10), exact) < 1e-9);
    }
}

void no_more_than_the_finite_eigenvalues_are_returned(void **) {
    const SparseMatrix k = membrane(20, 20);
    vector<double> mass(400, 0.0);
    mass[3] = mass[77] = 1;
    mass[399] = 1e-6;
    const auto three = lowest(k, diagonal(mass), 0, 10);
    assert_int_equal(three.values.size(), 3);
    assert_true(worst_error(k, diagonal(mass), three, condensed_values(k, mass)) < 1e-9);
    const auto none = lowest(k, diagonal(vector<double>(400, 0.0)), 0, 10);
    assert_int_equal(none.values.size(), 0);
    // rank one although every diagonal entry is positive: M = 1 1^T
    vector<std::int64_t> i, j;
    for (int a = 0; a < 100; ++a)
        for (int b = 0; b < 100; ++b) i.push_back(a), j.push_back(b);
    const SparseMatrix ones = plm::from_triplets(100, 100, i, j, vector<double>(10000, 1.0));
    const auto one = lowest(membrane(10, 10), ones, 0, 3);
    assert_int_equal(one.values.size(), 1);
}

void all_eigenpairs_of_a_small_pencil_are_available(void **) {
    const SparseMatrix k = membrane(6, 5), m = unit_mass(30);
    const auto e = lowest(k, m, 0, 1000);
    assert_int_equal(e.values.size(), 30);
    assert_true(worst_error(k, m, e, membrane_values(6, 5)) < 1e-11);
    const auto none = lowest(k, m, 0, 0);
    assert_int_equal(none.values.size(), 0);
}

void the_answer_does_not_depend_on_the_units(void **) {
    const SparseMatrix k = membrane(20, 19), m = unit_mass(380);
    const auto reference = lowest(k, m, 0, 6);
    const SparseMatrix zero = diagonal(vector<double>(380, 0.0));
    const auto scaled = lowest(plm::add(1e11, k, 0, zero), plm::add(1e-9, m, 0, zero), 0, 6);
    for (int j = 0; j < 6; ++j)
        assert_true(std::fabs(scaled.values[j] / (1e20 * reference.values[j]) - 1) < 1e-11);
}

void two_runs_give_the_same_bits(void **) {
    const SparseMatrix k = membrane(20, 19), m = unit_mass(380);
    const auto a = lowest(k, m, 0, 6), b = lowest(k, m, 0, 6);
    assert_true(a.values == b.values);
    assert_true(max_difference(a.vectors.in_core(), b.vectors.in_core()) == 0);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(pairs_far_from_a_shift_beside_zero_are_told_apart),
        cmocka_unit_test(lanczos_agrees_with_lapack_on_random_pencils),
        cmocka_unit_test(arpack_and_lanczos_agree),
        cmocka_unit_test(a_vector_that_is_off_is_mended_beside_penalties),
        cmocka_unit_test(eigenvalues_beside_penalties_keep_their_digits),
        cmocka_unit_test(double_eigenvalues_of_a_square_membrane_come_in_pairs),
        cmocka_unit_test(a_copy_that_lanczos_misses_is_put_in),
        cmocka_unit_test(many_equal_copies_are_all_found),
        cmocka_unit_test(rigid_modes_are_found_with_a_negative_shift),
        cmocka_unit_test(massless_dofs_carry_no_mode),
        cmocka_unit_test(no_more_than_the_finite_eigenvalues_are_returned),
        cmocka_unit_test(all_eigenpairs_of_a_small_pencil_are_available),
        cmocka_unit_test(the_answer_does_not_depend_on_the_units),
        cmocka_unit_test(two_runs_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
