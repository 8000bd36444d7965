// Discontinuity vectors (Segalman 2007) against dense solutions over all DOFs of two chains in contact.
#include "reduction/discontinuity.hpp"
#include "rival_cases.hpp"
#include "space/linear_contact.hpp"
#include "space/rest.hpp"

using namespace rival;
using plm::Matrix;

namespace {

constexpr int n_pairs = 9;

Scene two_chains(bool supported) {
    return make_scene(test::two_chains(40, n_pairs, 300, supported), 0.2, 1);
}

// B K_c^-1 B^T of a contact set, dense over all DOFs.
Matrix dense_compliance(const exact::Structure &s, const plm::PairStates &states) {
    Matrix k = test::dense_stiffness(s, states), x(s.n, s.z);
    for (int p = 0; p < s.z; ++p)
        for (int i = 0; i < s.n; ++i) x(i, p) = s.gap_rows[p * s.n + i];
    const Matrix b = x;
    plm::DenseCholesky cholesky;
    if (!cholesky.factor(k)) return Matrix(s.z, s.z);
    cholesky.solve(x.data(), s.z, s.n);
    return plm::product('T', 'N', b, x);
}

Matrix reduced_compliance(const plm::ReducedModel &r, const plm::PairStates &states) {
    const plm::vector<double> spring = r.contact.springs(states);
    Matrix c(r.n_pairs(), r.n_pairs());
    for (std::int64_t p = 0; p < r.n_pairs(); ++p) {
        plm::vector<double> x(r.size());
        for (std::int64_t j = 0; j < r.size(); ++j) x[j] = r.gap(p, j);
        plm::solve_with_springs(r.lambda, r.gap, spring, x);
        plm::gemv('N', 1.0, r.gap, x.data(), 0.0, c.col(p));
    }
    return c;
}

double compliance_error(const exact::Structure &s, const plm::ReducedModel &r,
                        const plm::PairStates &states) {
    const Matrix want = dense_compliance(s, states), got = reduced_compliance(r, states);
    double worst = 0, size = 0;
    for (std::int64_t i = 0; i < s.z * s.z; ++i) {
        worst = std::max(worst, std::abs(got.data()[i] - want.data()[i]));
        size = std::max(size, std::abs(want.data()[i]));
    }
    return worst / size;
}

// With a vector for every joint the static response of the gaps is exact, whatever is closed.
void with_all_vectors_the_contact_compliance_is_exact(void **) {
    const Scene s = two_chains(true);
    const auto basis = build(s, kind(&plm::basis_kinds::discontinuity));
    const auto modes =
        span_of(*s.full->space(), linear_modes(*s.full->space(), true, basis->reduced()->size()));
    const plm::PairStates none = plm::PairStates::all_open(n_pairs),
                          all = plm::PairStates::all_closed(n_pairs);
    plm::PairStates some = none;
    for (int pair : {1, 4, 8}) some.switch_pair(pair);
    for (const auto &states :
         {none, all, some}) { // singular values are cut at 1e-6: squared in the compliance
        assert_true(below(compliance_error(s.structure, *basis->reduced(), states), 1e-9));
        assert_true(compliance_error(s.structure, *modes, states) > 1e-3); // as many modes: not
    }
}

// Each vector is K_ref^-1 B_i^T beside the modes: together they hold the field of least energy with a unit
// jump.
void the_field_of_least_energy_with_one_jump_is_in_the_basis(void **) {
    const Scene s = two_chains(true);
    const auto basis = build(s, kind(&plm::basis_kinds::discontinuity));
    Matrix k =
        test::dense_stiffness(s.structure, plm::PairStates::all_closed(n_pairs)); // homogeneous: all closed
    plm::DenseCholesky cholesky;
    assert_true(cholesky.factor(k));
    for (int p = 0; p < n_pairs; ++p) {
        plm::vector<double> field(s.structure.n);
        for (int i = 0; i < s.structure.n; ++i) field[i] = s.structure.gap_rows[p * s.structure.n + i];
        cholesky.solve(field.data(), 1, s.structure.n);
        // the space holds attachment vectors of the open system; what conditioning drops weighs 1e-6
        assert_true(below(plm::projection_residual(*basis, false, true, plm::Field(field)), 1e-5));
    }
}

void the_reference_is_the_contact_at_rest(void **) {
    exact::Structure pressed = test::two_chains(40, n_pairs, 300, true);
    pressed.preload[39] = 2;
    pressed.preload[79] = -2;
    pressed.preload[20] = -6;
    for (const exact::Structure &structure : {pressed, test::two_chains(40, n_pairs, 300, true)}) {
        const Scene s = make_scene(structure, 0.2, 1);
        plm::SelectionRule rule;
        rule.min_hz = s.window.min_hz, rule.max_hz = s.window.max_hz;
        const auto d = plm::discontinuous_modes(*s.full->space(), rule, 0, plm::Watch());
        const std::int64_t n_closed = d.reference.n_closed();
        assert_true(structure.preload[39] == 0 ? n_closed == n_pairs
                                               : d.reference == plm::rest_of(*s.full->space())->states);
        if (structure.preload[39] != 0) assert_true(n_closed > 0 && n_closed < n_pairs);
    }
}

void rigid_body_motion_is_kept_once(void **) {
    const Scene s = two_chains(false);
    const auto basis = build(s, kind(&plm::basis_kinds::discontinuity));
    assert_true(basis->reduced()->lambda[0] == 0 && basis->reduced()->lambda[1] > 1e-6);
    const plm::vector<double> rigid(80, 1.0);
    assert_true(below(plm::projection_residual(*basis, false, true, plm::Field(rigid)),
                      1e-7)); // of the space's modes
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(with_all_vectors_the_contact_compliance_is_exact),
        cmocka_unit_test(the_field_of_least_energy_with_one_jump_is_in_the_basis),
        cmocka_unit_test(the_reference_is_the_contact_at_rest),
        cmocka_unit_test(rigid_body_motion_is_kept_once),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
