// Matrices in the coordinates of a basis: what is diagonal there is kept so.
#include "reduction/projection.hpp"
#include "sampling/small_models.hpp"
#include "support/test.hpp"

namespace {

// C = c M or c K as a matrix, or one of no kind, on the six lowest modes.
enum class Kind { of_mass, of_stiffness, other };
plm::ProjectedDamping damping_of(Kind kind, plm::vector<double> &lambda) {
    exact::Structure s = test::two_chains(8, 3, 5, true);
    for (int i = 0; i < s.n; ++i)
        for (int j = 0; j < s.n; ++j)
            s.damping[i * s.n + j] = kind == Kind::of_stiffness ? 0.1 * s.stiffness[i * s.n + j]
                                     : i != j                   ? 0
                                     : kind == Kind::of_mass    ? 0.1 * s.mass[i]
                                                                : 0.1 * (i + 1);
    test::ModelExtras extras;
    extras.explicit_damping = true;
    const auto space = plm::make_contact_space(test::make_model(s, extras), 3.0, 10, plm::Watch());
    plm::Matrix first(space->size(), 6);
    for (int j = 0; j < 6; ++j) first(j, j) = 1;
    const plm::Coordinates modes = plm::diagonalise(*space, first);
    lambda = modes.lambda;
    return plm::projected_damping(*space, modes);
}

void a_damping_matrix_that_the_modes_diagonalise_is_diagonal(void **) {
    plm::vector<double> lambda;
    for (Kind kind : {Kind::of_mass, Kind::of_stiffness}) {
        const plm::ProjectedDamping d = damping_of(kind, lambda);
        assert_true(d.matrix.empty());
        assert_int_equal(d.diagonal.size(), 6);
        for (std::size_t j = 0; j < 6; ++j)
            assert_true(close_to(d.diagonal[j], kind == Kind::of_mass ? 0.1 : 0.1 * lambda[j], 1e-10));
    }
    const plm::ProjectedDamping other = damping_of(Kind::other, lambda);
    assert_true(other.diagonal.empty() && other.matrix.rows() == 6);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_damping_matrix_that_the_modes_diagonalise_is_diagonal),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
