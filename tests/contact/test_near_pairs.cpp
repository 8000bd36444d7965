// Penetrations as polynomials: whole where a pair may come to zero, the side alone where not.
#include "contact/near_pairs.hpp"
#include "support/test.hpp"
#include <cmath>

namespace {

// Two coordinates, three pairs; y = (1 + 2 s, 3 - s^2).
plm::Matrix gap_by_pair() {
    plm::Matrix g(2, 3);
    g(0, 0) = 1, g(1, 0) = 0;
    g(0, 1) = 0, g(1, 1) = 1;
    g(0, 2) = 1, g(1, 2) = -1;
    return g;
}
plm::Matrix powers() {
    plm::Matrix y(2, 3);
    y(0, 0) = 1, y(0, 1) = 2, y(1, 0) = 3, y(1, 2) = -1;
    return y;
}

// The second pair, at 3 + 10, goes no farther than 1. Beside the coordinates, 10 + s acts on it.
plm::Matrix expanded(char op, double travel_of_second) {
    plm::Matrix penetration(3, 3);
    penetration(0, 1) = 10, penetration(1, 1) = 1;
    plm::NearPairs().expand({1, 13, -2}, {2, travel_of_second, 3}, gap_by_pair(), op,
                            op == 'T' ? powers() : powers().transposed(), penetration);
    return penetration;
}

void near_pairs_are_polynomials_and_far_ones_a_side(void **) {
    for (char op : {'T', 'N'})
        for (double travel : {2.0, 13.0}) {
            const plm::Matrix p = expanded(op, travel);
            const double second[] = {13, travel < 13 ? 0.0 : 1.0, travel < 13 ? 0.0 : -1.0};
            const double first[] = {1, 2, 0}, third[] = {-2, 2, 1};
            for (int k = 0; k < 3; ++k) {
                assert_true(p(k, 0) == first[k]);
                assert_true(p(k, 1) == second[k]);
                assert_true(p(k, 2) == third[k]);
            }
        }
}

void a_pair_whose_way_is_not_known_is_near(void **) {
    assert_true(expanded('N', NAN)(2, 1) == -1);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(near_pairs_are_polynomials_and_far_ones_a_side),
        cmocka_unit_test(a_pair_whose_way_is_not_known_is_near),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
