// GMRES against the LU of the same matrix: the solution, the number of steps, the sign of the determinant,
// and what happens when it does not get there.
#include "linalg/gmres.hpp"
#include "linalg/lapack.hpp"
#include "support.hpp"
#include <cmath>
#include <random>

using namespace test;

namespace {

// I + a random matrix of low rank, preconditioned by a diagonal matrix that is not far from I.
class Equations final : public plm::LinearEquations {
  public:
    Equations(std::int64_t n, std::int64_t rank, double size, unsigned seed) : matrix(n, n), diagonal(n) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        plm::Matrix a(n, rank), b(n, rank);
        for (std::int64_t k = 0; k < n * rank; ++k)
            a.data()[k] = normal(random), b.data()[k] = normal(random);
        plm::gemm('N', 'T', size / static_cast<double>(n), a, b, 0.0, matrix);
        for (std::int64_t i = 0; i < n; ++i) {
            diagonal[i] = 1 + 0.5 * std::cos(static_cast<double>(i));
            matrix(i, i) += 1;
            for (std::int64_t j = 0; j < n; ++j) matrix(j, i) *= diagonal[i];
        }
    }
    void product(const double *x, double *y) override { plm::gemv('N', 1.0, matrix, x, 0.0, y); }
    void precondition(double *v) override {
        for (std::size_t i = 0; i < diagonal.size(); ++i) v[i] /= diagonal[i];
    }
    plm::Matrix matrix;
    plm::vector<double> diagonal;
};

// Krylov spaces of a matrix that differs from I by rank k have k + 1 dimensions.
void low_rank_is_solved_in_as_many_steps(void **) {
    int n_negative = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        Equations equations(60, 5, 4.0, seed);
        const plm::vector<double> b = plm::patternless_vector(60);
        plm::vector<double> x = b, want = b;
        plm::Gmres gmres;
        assert_true(gmres.solve(equations, 60, x.data(), 1e-12, 20));
        assert_true(gmres.n_steps() <= 6);
        plm::RealLu lu;
        lu.factor(equations.matrix);
        lu.solve(want.data(), 1, 60);
        double worst = 0;
        for (int i = 0; i < 60; ++i) worst = std::max(worst, std::abs(x[i] - want[i]) / std::abs(want[i]));
        assert_true(worst < 1e-6); // entries against themselves: condition times 1e-12
        assert_int_equal(gmres.determinant_sign(), lu.determinant_sign()); // the preconditioner's is 1
        n_negative += lu.determinant_sign() < 0;
    }
    assert_true(n_negative > 3 && n_negative < 17);
}

void too_few_steps_keep_the_right_hand_side(void **) {
    Equations equations(60, 5, 4.0, 1);
    const plm::vector<double> b = plm::patternless_vector(60);
    plm::vector<double> x = b;
    plm::Gmres gmres;
    assert_false(gmres.solve(equations, 60, x.data(), 1e-12, 3));
    assert_true(x == b);
    x.assign(60, 0.0); // nothing to do
    assert_true(gmres.solve(equations, 60, x.data(), 1e-12, 3));
    assert_int_equal(gmres.n_steps(), 0);
    x.assign(60, NAN);
    assert_false(gmres.solve(equations, 60, x.data(), 1e-12, 20));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(low_rank_is_solved_in_as_many_steps),
        cmocka_unit_test(too_few_steps_keep_the_right_hand_side),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
