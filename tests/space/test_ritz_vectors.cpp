// Coordinates of a basis from the eigenpairs of the mass in it, one by one: shifted structures, directions
// without mass.
#include "space/massless.hpp"
#include "support/spring_models.hpp"
#include "support/test.hpp"

namespace {

// (K + sigma M)-orthonormal directions with eigenvalues lambda: of mass 1 / (lambda + sigma).
plm::RitzVectors of(const plm::vector<double> &lambda, double sigma, double reach) {
    const std::int64_t n = static_cast<std::int64_t>(lambda.size());
    plm::vector<double> mu;
    plm::Matrix y(n, n);
    for (std::int64_t j = n; j-- > 0;) { // ascending
        mu.push_back(1 / (lambda[j] + sigma));
        y(j, n - 1 - j) = 1;
    }
    return plm::ritz_vectors(mu, y, sigma, reach);
}

void the_shift_is_taken_off_again(void **) {
    const plm::vector<double> lambda{0, 1, 10, 1000};
    for (double sigma : {0.1, 3.0}) {
        const plm::RitzVectors r = of(lambda, sigma, 0);
        assert_int_equal(r.n_massless, 0);
        for (std::int64_t j = 0; j < 4; ++j) {
            assert_true(near(r.lambda[j], lambda[j], 1e-13));
            for (std::int64_t i = 0; i < 4; ++i)
                assert_true(near(r.vectors(i, j), i == j ? std::sqrt(lambda[j] + sigma) : 0, 1e-14));
        }
    }
}

// A thousand times faster than the fastest of interest is without mass: stiffness reach^2.
void what_is_too_fast_has_no_mass(void **) {
    const double reach = 2;
    const plm::RitzVectors r = of({1, 3, 1e8}, 0.5, reach);
    assert_int_equal(r.n_massless, 1);
    assert_true(near(r.lambda[0], 1, 1e-14) && near(r.lambda[1], 3, 1e-14) && r.lambda[2] == reach * reach);
    assert_true(r.vectors(2, 2) == reach);
}

// Of two masses on springs of their own, of which the second counts for nothing: its momentum says nothing of
// where it is, its elastic force does.
plm::Matrix recovered(const plm::Matrix &motions) {
    const auto model = test::build(test::input({{1, 0}, {0, 1e-9}}, {{4, 0}, {0, 9}}));
    return plm::coordinates_of(
        *model, plm::Field(motions), [](const plm::Field &forces) { return forces.in_core(); }, {4, 9}, 1);
}
void a_motion_without_mass_is_known_by_its_force(void **) {
    plm::Matrix motions(2, 3);
    for (std::int64_t k = 0; k < 6; ++k) motions.data()[k] = std::cos(1.0 + static_cast<double>(k));
    const plm::Matrix c = recovered(motions);
    assert_true(c.rows() == 2 && c.cols() == 3);
    for (std::int64_t k = 0; k < 6; ++k) assert_true(near(c.data()[k], motions.data()[k], 1e-14));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_shift_is_taken_off_again),
        cmocka_unit_test(what_is_too_fast_has_no_mass),
        cmocka_unit_test(a_motion_without_mass_is_known_by_its_force),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
