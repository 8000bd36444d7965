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

void bad_input_never_reaches_lapack(void **) {
    const auto shape = outcome_of([] { plm::general_eigenvalues(Matrix(2, 3)); });
    const auto nan = outcome_of([] {
        Matrix a(2, 2);
        a(0, 1) = std::numeric_limits<double>::quiet_NaN();
        plm::general_eigenvalues(a);
    });
    assert_int_equal(shape.status, PLM_ERR_INTERNAL);
    assert_int_equal(nan.status, PLM_ERR_MATRIX);
    assert_true(plm::general_eigenvalues(Matrix()).empty());
    assert_true(plm::general_eigen(Matrix()).values.empty());
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(eigenvalues_of_a_cyclic_shift_are_roots_of_unity),
        cmocka_unit_test(vectors_belong_to_their_values),
        cmocka_unit_test(bad_input_never_reaches_lapack),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
