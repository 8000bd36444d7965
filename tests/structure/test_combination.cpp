// A factored sum of a structure's matrices, against its 2 x 2 inverse by hand.
#include "structure/combination.hpp"
#include "support/spring_models.hpp"
#include "support/test.hpp"

namespace {

// M = diag(2, 3), K = [5 -1; -1 4], C = diag(1, 0.5); the residual of the sum's solution of (1, -2).
double error_of(const plm::MatrixWeights &w) {
    plm::ModelInput in = test::input({{2, 0}, {0, 3}}, {{5, -1}, {-1, 4}});
    in.damping_matrix = test::matrix({{1, 0}, {0, 0.5}});
    const auto model = test::build(in);
    plm::Combination sum(*model, w);
    sum.factor();
    plm::Field x(plm::vector<double>{1, -2});
    sum.solve(x);
    const double a = 2 * w.mass + 5 * w.stiffness + w.damping, b = -w.stiffness,
                 d = 3 * w.mass + 4 * w.stiffness + 0.5 * w.damping;
    return std::hypot(a * x.at(0) + b * x.at(1) - 1, b * x.at(0) + d * x.at(1) + 2);
}

void a_sum_has_all_that_is_weighted(void **) {
    for (const plm::MatrixWeights &w : {plm::MatrixWeights{1, 0, 0}, plm::MatrixWeights{0, 1, 0},
                                        plm::MatrixWeights{0, 0, 1}, plm::MatrixWeights{0.7, 1.3, 2.1}})
        assert_true(below(error_of(w), 1e-14));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_sum_has_all_that_is_weighted),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
