// Eigenproblems without symmetry, against closed forms and their own definition.
#include "linalg/lapack.hpp"
#include "support.hpp"
#include <limits>

using namespace test;
using Complex = std::complex<double>;

namespace {

// Companion matrix of x^n = 1: its eigenvalues are the n-th roots of unity.
Matrix cyclic_shift(std::int64_t n) {
    Matrix a(n, n);
    for (std::int64_t i = 0; i < n; ++i) a((i + 1) % n, i) = 1;
    return a;
}

double distance_from_roots_of_unity(std::int64_t n) {
    double worst = 0;
    for (const Complex &v : plm::general_eigenvalues(cyclic_shift(n)))
        worst = std::max(worst, std::abs(std::pow(v, static_cast<double>(n)) - 1.0));
    return worst;
}
void eigenvalues_of_a_cyclic_shift_are_roots_of_unity(void **) {
    assert_true(distance_from_roots_of_unity(1) < 1e-15);
    assert_true(distance_from_roots_of_unity(2) < 1e-14);
    assert_true(distance_from_roots_of_unity(7) < 1e-13);
}

struct Check {
    double residual = 0, norm = 0; // |A x - lambda x|, ||x| - 1|
    bool ordered = true, conjugate = true, same_values = true;
};
Check check_random(std::int64_t n) {
    const Matrix a = random_matrix(n, n, 5);
    const plm::GeneralEigen e = plm::general_eigen(a);
    const auto values = plm::general_eigenvalues(a);
    Check c;
    for (std::int64_t j = 0; j < n; ++j) {
        const Complex *x = e.vectors.data() + n * j;
        double size = 0;
        for (std::int64_t i = 0; i < n; ++i) {
            Complex r = -e.values[j] * x[i];
            for (std::int64_t k = 0; k < n; ++k) r += a(i, k) * x[k];
            c.residual = std::max(c.residual, std::abs(r));
            size += std::norm(x[i]);
        }
        c.norm = std::max(c.norm, std::fabs(std::sqrt(size) - 1));
        c.same_values = c.same_values && std::abs(values[j] - e.values[j]) < 1e-12;
        if (j > 0) c.ordered = c.ordered && std::abs(e.values[j]) <= std::abs(e.values[j - 1]) * (1 + 1e-15);
        if (e.values[j].imag() > 0) c.conjugate = c.conjugate && e.values[j + 1] == std::conj(e.values[j]);
    }
    return c;
}
void vectors_belong_to_their_values(void **) {
    const Check c = check_random(23);
    assert_true(c.residual < 1e-12);
    assert_true(c.norm < 1e-13);
    assert_true(c.ordered && c.conjugate && c.same_values);
}

// Two free bodies, each a defective pair of rates 0, and three oscillators, mixed by a random matrix: the
// eigenvectors of the former coincide, the invariant subspaces do not.
void what_is_slow_has_a_subspace_of_its_own(void **) {
    constexpr std::int64_t n = 10;
    Matrix block(n, n), mixed(n, n);
    block(0, 1) = block(2, 3) = 1;
    for (std::int64_t k = 2; k < 5; ++k) {
        const auto w = static_cast<double>(10 * k);
        block(2 * k, 2 * k + 1) = w, block(2 * k + 1, 2 * k) = -w, block(2 * k + 1, 2 * k + 1) = -0.1;
    }
    const Matrix mix = random_matrix(n, n, 9);
    plm::RealLu lu;
    Matrix factor = mix.transposed(), right = plm::product('N', 'N', mix, block).transposed();
    lu.factor(factor);
    lu.solve(right.data(), n, n); // (mix block mix^-1)^T
    const Matrix a = right.transposed();
    const plm::SplitSpectrum s = plm::split_spectrum(a, 1e-3);
    assert_int_equal(s.slow.cols(), 4);
    assert_int_equal(s.rest.cols(), 6);
    const auto defect = [&](const Matrix &x, const Matrix &b) {
        Matrix r = plm::product('N', 'N', x, b);
        plm::gemm('N', 'N', 1.0, a, x, -1.0, r);
        return plm::norm2(r.rows() * r.cols(), r.data());
    };
    // rounding of A, of norm some hundreds
    assert_true(defect(s.slow, s.slow_block) < 1e-11 && defect(s.rest, s.rest_block) < 1e-10);
    const Matrix twice = plm::product('N', 'N', s.slow_block, s.slow_block); // nilpotent
    assert_true(plm::norm2(16, twice.data()) < 1e-10);
    for (const Complex &v : plm::general_eigenvalues(s.rest_block)) assert_true(std::abs(v) > 19);
    assert_int_equal(plm::split_spectrum(a, 1e-30).slow.cols(), 0);
    assert_int_equal(plm::split_spectrum(a, 1e3).rest.cols(), 0);
}

void bad_input_never_reaches_lapack(void **) {
    const auto shape = outcome_of([] { plm::general_eigenvalues(Matrix(2, 3)); });
    const auto nan = outcome_of([] {
        Matrix a(2, 2);
        a(0, 1) = std::numeric_limits<double>::quiet_NaN();
        plm::general_eigenvalues(a);
    });
    assert_int_equal(shape.status, plm::status::internal);
    assert_int_equal(nan.status, plm::status::matrix);
    assert_true(plm::general_eigenvalues(Matrix()).empty());
    assert_true(plm::general_eigen(Matrix()).values.empty());
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(eigenvalues_of_a_cyclic_shift_are_roots_of_unity),
        cmocka_unit_test(vectors_belong_to_their_values),
        cmocka_unit_test(what_is_slow_has_a_subspace_of_its_own),
        cmocka_unit_test(bad_input_never_reaches_lapack),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
