// Penetrations as polynomials: whole where a pair may come to zero, the side alone where not.
#include "contact/piece_penetrations.hpp"
#include "support/test.hpp"
#include <cmath>

namespace {

using Pairs = plm::vector<std::int64_t>;

// y = (1 + 2 s, 3 - s^2).
plm::Matrix powers() {
    plm::Matrix y(2, 3);
    y(0, 0) = 1, y(0, 1) = 2, y(1, 0) = 3, y(1, 2) = -1;
    return y;
}

// Pair i has the row (i, 1); beside the coordinates, -4 + s acts on it: i - 1 + (2 i + 1) s - s^2.
plm::PiecePenetrations expanded(char op, const plm::vector<double> &travel) {
    const std::int64_t z = static_cast<std::int64_t>(travel.size());
    plm::Matrix gap_by_pair(2, z), aside(z, 2);
    plm::vector<double> at_begin;
    for (std::int64_t i = 0; i < z; ++i) {
        gap_by_pair(0, i) = static_cast<double>(i), gap_by_pair(1, i) = 1;
        aside(i, 0) = -4, aside(i, 1) = 1;
        at_begin.push_back(static_cast<double>(i) - 1);
    }
    plm::PiecePenetrations piece;
    piece.expand(at_begin, travel, gap_by_pair, op, op == 'T' ? powers() : powers().transposed(), aside);
    return piece;
}

void check(const plm::PiecePenetrations &piece, const Pairs &near) {
    assert_true(piece.near() == near);
    assert_true(piece.powers().rows() == 3 &&
                piece.powers().cols() == static_cast<std::int64_t>(near.size()));
    for (std::size_t i = 0; i < piece.at_begin().size(); ++i)
        assert_true(piece.at_begin()[i] == static_cast<double>(i) - 1);
    for (std::size_t c = 0; c < near.size(); ++c) {
        const double i = static_cast<double>(near[c]), *p = piece.powers().col(static_cast<std::int64_t>(c));
        assert_true(p[0] == i - 1 && p[1] == 2 * i + 1 && p[2] == -1);
    }
}

void near_pairs_are_polynomials_and_far_ones_a_side(void **) {
    for (char op : {'T', 'N'}) {
        check(expanded(op, {0.5, 0.5, 2, 1, 3}), {1, 2, 4});
        check(expanded(op, {0, 0, 0, 0, 0}), {1}); // what is at zero is near, whatever its way
        check(expanded(op, {0.5, 5, 5, 5, 5, 5}), {0, 1, 2, 3, 4, 5}); // nearly all: all
        check(expanded(op, {0.5}), {});
    }
}

void a_pair_whose_way_is_not_known_is_near(void **) {
    check(expanded('N', {0.5, 0.5, 0.5, NAN}), {1, 3});
}

void what_may_act_besides_draws_pairs_nearer_to_zero(void **) {
    plm::PiecePenetrations piece = expanded('N', {3, 0, 0, 0, 0});
    piece.draw_near({0.25, 0, 7, 7, 7});
    assert_true(piece.near() == (Pairs{0, 1}));
    assert_true(piece.powers()(0, 0) == -0.75 && piece.powers()(0, 1) == 0);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(near_pairs_are_polynomials_and_far_ones_a_side),
        cmocka_unit_test(a_pair_whose_way_is_not_known_is_near),
        cmocka_unit_test(what_may_act_besides_draws_pairs_nearer_to_zero),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
