// The static offset for contacts without pre-load (paper, 2.3.1) against dense solutions and closed forms.
#include "sampling/dominant_mode.hpp"
#include "sampling/static_offset.hpp"
#include "small_models.hpp"
#include "support/test.hpp"
#include <algorithm>

using plm::LinearSystem;
using plm::Matrix;

namespace {

// dX_0 = -B K_ref^-1 B^T |dV| over all DOFs.
Matrix dense_offset(const exact::Structure &s, LinearSystem system, const plm::vector<double> &dv) {
    Matrix load(s.n, 1), rows(s.z, s.n);
    for (int p = 0; p < s.z; ++p)
        for (int j = 0; j < s.n; ++j) {
            rows(p, j) = s.gap_rows[p * s.n + j];
            load(j, 0) -= rows(p, j) * std::abs(dv[p]);
        }
    Matrix k = test::dense_stiffness(s, system == LinearSystem::sliding ? plm::PairStates::all_closed(s.z)
                                                                        : plm::PairStates::all_open(s.z));
    plm::DenseCholesky cholesky;
    cholesky.factor(k);
    cholesky.solve(load.data(), 1, s.n);
    return plm::product('N', 'N', rows, load);
}

double worst_error(const exact::Structure &s, LinearSystem system) {
    const auto space = plm::make_contact_space(test::make_model(s), 5.0, 10, plm::Watch());
    plm::vector<double> dv;
    for (int p = 0; p < s.z; ++p) dv.push_back(std::cos(2.0 * p));
    const plm::vector<double> got = plm::static_offset(*space, system, dv);
    const Matrix want = dense_offset(s, system, dv);
    double error = 0, size = 0;
    for (int p = 0; p < s.z; ++p) {
        error = std::max(error, std::abs(got[p] - want(p, 0)));
        size = std::max(size, std::abs(want(p, 0)));
    }
    return error / size;
}

// Two free masses with nothing but a contact spring between them.
exact::Structure free_pair(double contact_stiffness) {
    exact::Structure s;
    s.n = 2;
    s.z = 1;
    s.mass = {1, 3};
    s.stiffness.assign(4, 0.0);
    s.damping.assign(4, 0.0);
    s.gap_rows = {1, -1};
    s.contact_stiffness = {contact_stiffness};
    s.gap = {0};
    s.force = {1, 0};
    s.preload = {0, 0};
    return s;
}

double free_offset(LinearSystem system) {
    const auto space = plm::make_contact_space(test::make_model(free_pair(8)), 1.0, 2, plm::Watch());
    plm::vector<double> dv(1, -0.4);
    return plm::static_offset(*space, system, dv)[0];
}

double largest_offset(double contact_stiffness) {
    const exact::Structure s = test::two_chains(20, 6, contact_stiffness, false);
    const auto space = plm::make_contact_space(test::make_model(s), 5.0, 10, plm::Watch());
    const auto offset = plm::static_offset(*space, LinearSystem::sliding, plm::vector<double>(6, 1.0));
    return *std::max_element(offset.begin(), offset.end());
}

void the_open_offset_equals_the_dense_solution(void **) {
    assert_true(below(worst_error(test::two_chains(20, 6, 500, true), LinearSystem::open), 1e-9));
}

void the_sliding_offset_equals_the_dense_solution(void **) {
    assert_true(below(worst_error(test::two_chains(20, 6, 500, true), LinearSystem::sliding), 1e-9));
    assert_true(below(worst_error(test::two_chains(20, 6, 1e-2, true), LinearSystem::sliding), 1e-9));
    assert_true(below(worst_error(test::two_chains(20, 6, 1e9, true), LinearSystem::sliding), 1e-5));
}

void rigid_body_motion_is_left_out(void **) {
    // the contact spring alone balances F_A = |dV| against F_B = -F_A: u = -|dV| / k_n
    assert_true(near(free_offset(LinearSystem::sliding), -0.4 / 8, 1e-14));
    assert_true(near(free_offset(LinearSystem::open), 0, 1e-14));
}

void the_offset_opens_a_free_structure_too(void **) {
    assert_true(largest_offset(1e2) < 0);
    assert_true(largest_offset(1e7) < 0);
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_open_offset_equals_the_dense_solution),
        cmocka_unit_test(the_sliding_offset_equals_the_dense_solution),
        cmocka_unit_test(rigid_body_motion_is_left_out),
        cmocka_unit_test(the_offset_opens_a_free_structure_too),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
