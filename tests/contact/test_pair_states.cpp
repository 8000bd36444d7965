// States of pairs as a value, by hand.
#include "contact/event_sequence.hpp"
#include "contact/pair_states.hpp"
#include "support/test.hpp"

using plm::PairStates;

namespace {

PairStates first_and_third_of_four() {
    const std::int32_t flags[] = {1, 0, 7, 0}; // not 0: closed
    return PairStates::from_flags(flags, 4);
}

void flags_come_back_as_zeros_and_ones(void **) {
    const PairStates states = first_and_third_of_four();
    assert_true(states.flags() == (plm::vector<std::int64_t>{1, 0, 1, 0}));
    assert_true(states.closed_pairs() == (plm::vector<std::int64_t>{0, 2}));
    assert_true(states.size() == 4 && states.n_closed() == 2 && !states.empty());
    assert_true(states.is_closed(2) && !states.is_closed(3));
}

void all_pairs_alike_are_each_others_inverse(void **) {
    const PairStates open = PairStates::all_open(5), closed = PairStates::all_closed(5);
    assert_true(open.n_closed() == 0 && closed.n_closed() == 5);
    assert_true(open.inverted() == closed && closed.inverted() == open && open != closed);
    assert_true(PairStates().empty() && PairStates() == PairStates::all_open(0));
}

void what_is_inverted_twice_is_the_same(void **) {
    const PairStates states = first_and_third_of_four(), other = states.inverted();
    assert_true(states.n_different(other) == 4 && other.inverted() == states);
}

void a_switched_pair_is_the_one_difference(void **) {
    PairStates states = first_and_third_of_four();
    states.switch_pair(1);
    assert_true(states.is_closed(1) && states.n_different(first_and_third_of_four()) == 1);
    states.switch_pair(1);
    assert_true(states.n_different(first_and_third_of_four()) == 0);
}

// Pair 0: u = cos t, closed at first, zeros at 1/4 and 3/4 of the period. Pair 1: u = -2 + cos t, always
// open. Pair 2: u = 1/2 - sin t, zeros at 1/12 and 5/12.
plm::EventSequence three_pairs() {
    plm::Matrix u(3, 3);
    u(0, 1) = 1;
    u(1, 0) = -2, u(1, 1) = 1;
    u(2, 0) = 0.5, u(2, 2) = -1;
    return plm::event_sequence(u, 12.0);
}

void events_are_the_zeros_in_order(void **) {
    const plm::EventSequence sequence = three_pairs();
    assert_true(sequence.first.flags() == (plm::vector<std::int64_t>{1, 0, 1}));
    const double time[] = {1, 3, 5, 9};
    const std::int64_t pair[] = {2, 0, 2, 0};
    assert_int_equal(sequence.events.size(), 4);
    for (int k = 0; k < 4; ++k)
        assert_true(near(sequence.events[k].time, time[k], 1e-13) && sequence.events[k].pair == pair[k]);
    assert_true(sequence.acting() == (plm::vector<char>{1, 0, 1}));
    PairStates states = sequence.first;
    for (const plm::ContactEvent &event : sequence.events) pass_event(states, event);
    assert_true(states == sequence.first); // periodic
}

void an_event_that_leaves_the_period_comes_in_at_its_other_end(void **) {
    const plm::EventSequence next = three_pairs().moved({-2, 0, 0, 0}, 12.0); // from 1 to -1, that is 11
    assert_true(next.first.flags() == (plm::vector<std::int64_t>{1, 0, 0}));
    assert_true(next.events.back().pair == 2 && near(next.events.back().time, 11, 1e-13));
    assert_true(next.acting() == (plm::vector<char>{1, 0, 1}));
}

void the_wrong_side_is_that_of_the_other_state(void **) {
    const PairStates states = first_and_third_of_four();
    const double right[] = {1, -1, 2, -2}, wrong[] = {1, 0.25, -0.5, -2};
    assert_true(plm::wrong_side(states, right, 0) == 0);
    assert_true(plm::wrong_side(states, wrong, 0) == 0.5 && plm::wrong_side(states, wrong, 2) == 0.25);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(flags_come_back_as_zeros_and_ones),
        cmocka_unit_test(all_pairs_alike_are_each_others_inverse),
        cmocka_unit_test(what_is_inverted_twice_is_the_same),
        cmocka_unit_test(a_switched_pair_is_the_one_difference),
        cmocka_unit_test(events_are_the_zeros_in_order),
        cmocka_unit_test(an_event_that_leaves_the_period_comes_in_at_its_other_end),
        cmocka_unit_test(the_wrong_side_is_that_of_the_other_state),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
