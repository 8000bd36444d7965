// The law of a model's pairs in closed form: penetrations to states, forces, tangents, energy, springs.
#include "contact/contact.hpp"
#include "contact/contact_force.hpp"
#include "contact/contact_measures.hpp"
#include "contact/law_form.hpp"
#include "contact/piece_contact.hpp"
#include "contact/piece_events.hpp"
#include "support/test.hpp"

using plm::Contact;
using plm::Matrix;
using plm::PairStates;
using Reals = plm::vector<double>;

namespace {

Contact three_pairs() {
    return {{2, 3, 5}, {0.5, 0, -1}};
}

void penalty_law_of_every_pair(void **) {
    const Contact c = three_pairs();
    const Reals u{0.5, -1, 2};
    assert_true(c.forces(u) == (Reals{1, 0, 10}) && c.tangents(u) == (Reals{2, 0, 5}));
    assert_true(c.energy(0, u[0]) == 0.25 && c.energy(1, u[1]) == 0 && c.energy(2, u[2]) == 10);
    assert_true(c.states(u) == c.states_of_forces(c.forces(u)) && c.states(u).n_closed() == 2);
}

void without_loads_interference_alone_presses(void **) {
    Contact c = three_pairs();
    assert_true(c.unloaded_penetration() == (Reals{-0.5, 0, 1}) && c.has_interference());
    c.initial_gap[2] = 0;
    assert_true(!c.has_interference());
}

// Of the closed pairs 1 of 11 in force, of the open one all; the worse of both counts.
void states_agree_as_far_as_their_penetrations_do(void **) {
    const Contact c = three_pairs();
    const PairStates states = c.states({0.5, -1, 2});
    assert_true(c.agreement(states, {0.5, -1, 2}) == 1);
    assert_true(near(c.agreement(states, {0.5, -1, -2}), 1.0 / 11, 1e-15));
    assert_true(c.agreement(states, {0.5, 1, 2}) == 0);
}

void a_linear_system_has_the_springs_of_its_closed_pairs(void **) {
    const Contact c = three_pairs();
    assert_true(c.springs(PairStates::all_open(3)) == (Reals{0, 0, 0}));
    assert_true(c.springs(PairStates::all_closed(3)) == c.stiffness);
    assert_true(c.springs(c.states({0.5, -1, 2})) == (Reals{2, 0, 5}));
}

void at_zero_a_small_motion_closes_a_pair_half_of_the_time(void **) {
    assert_true(three_pairs().closed_shares({-1, 0, 1}) == (Reals{0, 0.5, 1}));
}

// Pressing as closed 2 x 3 of 2 x (3 + 1), parting as open 1 of 1 + 3.
void agreement_is_the_lesser_share(void **) {
    const Contact c{{2, 2, 1, 1}, {0, 0, 0, 0}};
    PairStates states = PairStates::all_open(4);
    states.switch_pair(0), states.switch_pair(1);
    assert_true(close_to(c.agreement(states, {3, -1, -1, 3}), 0.25, 1e-15));
    assert_true(close_to(c.agreement(states, {3, -1, -3, -1}), 0.75, 1e-15));
    assert_true(c.agreement(states, {1, 2, -1, -2}) == 1);
}

// Both forms are one law: with N = k u the compliant one has e (u + slack N) = N where u > 0, and v < 0 where
// u < 0, for any stiffness.
void both_forms_of_the_law_give_one_force(void **) {
    for (double k : {5.0, 1e3, 1e12}) {
        const Contact c{{k, 2}, {0, 0}};
        const plm::LawForm form = plm::compliance_form(c, 4, 3), penalty = plm::penalty_form(c);
        const Reals u{1.5 / k, 1.5};
        const Reals n = c.forces(u);
        assert_true(close_to(form.stiffness[0] * (u[0] + form.slack[0] * n[0]), n[0], 1e-14));
        assert_true(form.compliant && form.stiffness[1] == 2 && form.slack[1] == 0); // soft: as it is
        assert_true(!penalty.compliant && penalty.stiffness == c.stiffness && penalty.slack == (Reals{0, 0}));
        assert_true(!plm::compliance_form(c, 1e13, 3).compliant);
    }
}

Matrix two_motions() { // u0 = 1 + 2 cos t: closed for 2/3 of the period; u1 = -3 + sin t: never
    Matrix u(2, 3);
    u(0, 0) = 1, u(0, 1) = 2;
    u(1, 0) = -3, u(1, 2) = 1;
    return u;
}

void shares_of_the_period(void **) {
    const Reals share = plm::closed_shares(two_motions());
    assert_true(close_to(share[0], 2.0 / 3, 1e-14) && share[1] == 0);
    plm::ContactIndicator indicator;
    plm::make_event_force(1, 2)->indicator(two_motions(), indicator);
    assert_true(close_to(indicator.closed_share(), 1.0 / 3, 1e-14));
    assert_true(indicator.acts(0) && indicator.varies(0));
    assert_true(!indicator.acts(1) && !indicator.varies(1) && indicator.constant_share(1) == 0);
}

void how_far_the_next_pair_is_from_switching(void **) {
    assert_true(close_to(plm::factor_to_switching(two_motions()), 0.5, 1e-14));
    assert_true(std::isinf(plm::factor_to_switching(Matrix(1, 3))));
}

// Amplitudes 3 / 1 and 1 / 2; the pair at zero changes at once, the last one never.
void the_amplitude_at_which_the_first_pair_switches(void **) {
    assert_true(plm::amplitude_of_first_switch({-3, 1, 0, 1}, {1, -2, 1, 0}, {0, 1, 0.5, 1}) == 0.5);
    assert_true(plm::amplitude_of_first_switch({0, 1}, {1, 0}, {0.5, 1}) == 0);
}

void energy_of_springs_in_the_mean(void **) { // k <u^2> / 2 = k (1 + 2) / 2 and k (9 + 1/2) / 2
    const Matrix u = two_motions();
    Matrix force = u;
    for (std::int64_t c = 0; c < 3; ++c) force(0, c) *= 4, force(1, c) *= 2;
    assert_true(close_to(plm::mean_energy(force, u), 6 + 9.5, 1e-15));
}

// Springs of 2 and 3 along (1, 1) and (1, -1), one flexibility of 1/2 in series with the first.
void a_piece_of_the_flow_has_springs_in_series(void **) {
    const Contact c{{2, 3}, {0, 0}};
    Matrix gap(2, 2), none, flexibility(2, 2), stiffness;
    gap(0, 0) = gap(0, 1) = gap(1, 0) = 1, gap(1, 1) = -1;
    flexibility(0, 0) = 0.5;
    plm::PieceContact alone(c, gap, none, 2), series(c, gap, flexibility, 2);
    assert_true(alone.assign(PairStates::all_closed(2), stiffness));
    assert_true(close_to(stiffness(0, 0), 5, 1e-15) && close_to(stiffness(0, 1), -1, 1e-14));
    assert_true(!alone.assign(PairStates::all_closed(2), stiffness)); // as they are
    assert_true(series.assign(PairStates::all_closed(2), stiffness));
    assert_true(close_to(stiffness(0, 0), 4, 1e-15) && close_to(stiffness(0, 1), -2, 1e-14));
    Matrix u(2, 1), force;
    u(0, 0) = 1, u(1, 0) = 1;
    series.add_forces(u, force);
    assert_true(close_to(force(0, 0), 1, 1e-15) && close_to(u(0, 0), 0.5, 1e-15));
    assert_true(close_to(force(1, 0), 3, 1e-15) && close_to(u(1, 0), 1, 1e-15));
    assert_true(series.assign(PairStates::all_open(2), stiffness) && stiffness(0, 0) == 0);
}

// Along a sequence of states, by sums of groups of pairs, as for each alone.
void springs_are_summed_as_they_change(void **) {
    constexpr std::int64_t z = 37, n = 3;
    Contact c;
    Matrix gap(z, n), none;
    for (std::int64_t i = 0; i < z; ++i) {
        c.stiffness.push_back(i % 5 == 0 ? 1e12 : 1.0 + static_cast<double>(i));
        c.initial_gap.push_back(0);
        for (std::int64_t j = 0; j < n; ++j) gap(i, j) = std::sin(static_cast<double>(1 + i * n + j));
    }
    plm::PieceContact along(c, gap, none, n);
    PairStates states = PairStates::all_open(z);
    Matrix stiffness, alone;
    along.assign(states, stiffness);
    for (std::int64_t k = 0; k < 200; ++k) {
        const PairStates before = states;
        for (std::int64_t i = k * k % z; i < z; i += 11 + k % 9) states.switch_pair(i);
        assert_true(along.assign(states, stiffness));
        plm::PieceContact(c, gap, none, n).assign(states, alone);
        double rise = 0;
        for (std::int64_t i = 0; i < z; ++i)
            for (std::int64_t j = 0; j < n; ++j)
                if (states.is_closed(i) && !before.is_closed(i))
                    rise += c.stiffness[i] * gap(i, j) * gap(i, j);
        assert_true(close_to(along.growth_since(before), rise, 1e-14));
        for (std::int64_t e = 0; e < n * n; ++e)
            assert_true(
                below(std::abs(stiffness.data()[e] - alone.data()[e]), 1e-14 * (alone(0, 0) + alone(1, 1))));
    }
}

// u0 = 1 - 2 s opens at 1/2, u1 = -1 + 4 s closes at 1/4, u2 = s^2 leaves zero as a closed pair.
void the_first_event_of_a_piece(void **) {
    const Contact c{{1, 1, 1}, {0, 0, 0}};
    const Matrix gap(3, 1);
    Matrix u(3, 3);
    u(0, 0) = 1, u(1, 0) = -2;
    u(0, 1) = -1, u(1, 1) = 4;
    u(2, 2) = 1;
    plm::PiecePenetrations piece;
    piece.expand(u);
    plm::PieceEvents events(c, gap);
    events.guess({1, -1, 0});
    assert_true(!events.states().is_closed(2) && events.correct(piece, 0) && !events.correct(piece, 0));
    assert_true(events.states().closed_pairs() == (plm::vector<std::int64_t>{0, 2}));
    std::int64_t pair = -1;
    assert_true(close_to(events.first(piece, pair), 0.25, 1e-14) && pair == 1);
    assert_true(events.pass() == 1 && events.states().n_closed() == 3);
    Matrix still(3, 3);
    for (std::int64_t i = 0; i < 3; ++i) still(0, i) = 1;
    piece.expand(still);
    assert_true(!events.correct(piece, 0) && events.first(piece, pair) == 1 && pair == -1);
}

// u0 = 1 - 2 s, u1 = 1 - 2 (1 - 1e-9) s, u2 = 1 - 1.9 s: the second opens 5e-10 of the piece after the first.
void pairs_that_switch_at_once(void **) {
    const Contact c{{1, 1, 1}, {0, 0, 0}};
    const Matrix gap(3, 1);
    Matrix u(2, 3);
    for (std::int64_t i = 0; i < 3; ++i) u(0, i) = 1;
    u(1, 0) = -2, u(1, 1) = -2 * (1 - 1e-9), u(1, 2) = -1.9;
    plm::PiecePenetrations piece;
    piece.expand(u);
    for (const double together : {0.0, 1e-8}) {
        plm::PieceEvents events(c, gap);
        events.guess({1, 1, 1});
        assert_false(events.correct(piece, 0));
        std::int64_t pair = -1;
        const double share = events.first(piece, pair, together), last = together > 0 ? 0.5 + 5e-10 : 0.5;
        assert_true(pair == 0 && close_to(share, last, 1e-13));
        assert_true(events.pass() == (together > 0 ? 2 : 1) && events.states().is_closed(2));
    }
}

// u = -1 + 2 s, then from zero: by its velocity; by that no more than rounding would do; by its acceleration.
void a_pair_leaves_zero_clearly(void **) {
    const Contact c{{1}, {0}};
    plm::PieceEvents events(c, Matrix(1, 1));
    plm::PiecePenetrations piece;
    Matrix u(3, 1);
    u(0, 0) = -1, u(1, 0) = 2;
    piece.expand(u);
    events.guess({-1});
    std::int64_t pair = -1;
    assert_true(!events.correct(piece, 0) && events.leave_clearly() &&
                close_to(events.first(piece, pair), 0.5, 1e-14));
    assert_true(events.pass() == 1);
    u(0, 0) = 0;
    piece.expand(u);
    const plm::vector<double> exact{1e-16}, rough{1e-3};
    assert_true(!events.correct(piece, exact) && events.leave_clearly());
    assert_true(!events.correct(piece, rough) && !events.leave_clearly());
    u(1, 0) = 0, u(2, 0) = 2;
    piece.expand(u);
    assert_true(!events.correct(piece, exact) && !events.leave_clearly());
}

void nothing_that_moves_agrees_with_any_state(void **) {
    assert_true(three_pairs().agreement(PairStates::all_closed(3), {0, 0, 0}) == 1);
    assert_true(three_pairs().agreement(PairStates::all_open(3), {0, 0, 0}) == 1);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(penalty_law_of_every_pair),
        cmocka_unit_test(without_loads_interference_alone_presses),
        cmocka_unit_test(states_agree_as_far_as_their_penetrations_do),
        cmocka_unit_test(a_linear_system_has_the_springs_of_its_closed_pairs),
        cmocka_unit_test(at_zero_a_small_motion_closes_a_pair_half_of_the_time),
        cmocka_unit_test(agreement_is_the_lesser_share),
        cmocka_unit_test(both_forms_of_the_law_give_one_force),
        cmocka_unit_test(shares_of_the_period),
        cmocka_unit_test(how_far_the_next_pair_is_from_switching),
        cmocka_unit_test(the_amplitude_at_which_the_first_pair_switches),
        cmocka_unit_test(energy_of_springs_in_the_mean),
        cmocka_unit_test(a_piece_of_the_flow_has_springs_in_series),
        cmocka_unit_test(springs_are_summed_as_they_change),
        cmocka_unit_test(the_first_event_of_a_piece),
        cmocka_unit_test(pairs_that_switch_at_once),
        cmocka_unit_test(a_pair_leaves_zero_clearly),
        cmocka_unit_test(nothing_that_moves_agrees_with_any_state),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
