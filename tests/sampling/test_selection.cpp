// The choice of samples from sweeps of the contact area, by hand.
#include "sampling/sample_selection.hpp"
#include "support/sweeps.hpp"
#include "support/test.hpp"

using plm::ContactSweep;
using plm::SelectedSample;

namespace {

using test::numbers;
using test::text;

std::string text(const std::vector<SelectedSample> &samples) {
    std::string s;
    for (const SelectedSample &sample : samples)
        s += (s.empty() ? "" : " ") + text(sample.states) + (sample.complement ? "'" : "");
    return s;
}

std::string positions(std::int64_t size, std::int64_t n, bool ends) {
    ContactSweep sweep;
    sweep.samples.resize(size);
    for (std::int64_t i = 1; i < size; ++i) sweep.thresholds.push_back(static_cast<double>(i) - 2.5);
    std::string s;
    for (std::int64_t i : plm::equally_spaced(sweep, n, ends))
        s += (s.empty() ? "" : " ") + std::to_string(i);
    return s;
}

void samples_are_equally_spaced(void **) {
    assert_string_equal(positions(91, 4, true).c_str(), "0 30 60 90");
    assert_string_equal(positions(11, 4, true).c_str(), "0 3 7 10");
    assert_string_equal(positions(8, 4, false).c_str(), "1 3 5 7");
    assert_string_equal(positions(91, 4, false).c_str(), "11 34 56 79");
    assert_string_equal(positions(3, 4, true).c_str(), "0 1 2"); // more than there are: all
    assert_string_equal(positions(6, 1, true).c_str(), "2");     // the one at alpha = 0
    assert_string_equal(positions(6, 1, false).c_str(), "2");
    assert_string_equal(positions(1, 5, true).c_str(), "0");
}

void complements_come_after_and_only_when_new(void **) {
    const ContactSweep sweep = plm::sweep_contact(numbers({1, -1, 0.5}), true, numbers({1, 1, -1}));
    const std::vector<ContactSweep> one(1, sweep);
    assert_string_equal(text(plm::select_samples(one, 4, true, false, false)).c_str(), "..x x.x x.. xx.");
    // the complement of ..x is xx., that of xx. is ..x: both are there already
    assert_string_equal(text(plm::select_samples(one, 4, true, true, false)).c_str(),
                        "..x x.x x.. xx. .x.' .xx'");
    assert_string_equal(text(plm::select_samples(one, 2, true, true, false)).c_str(), "..x xx.");
    const auto selected = plm::select_samples(one, 4, true, true, false);
    assert_int_equal(selected[4].sweep_index, 1);
    assert_int_equal(selected[4].states.n_closed(), 1);
}

void several_dominant_modes_share_their_samples(void **) {
    std::vector<ContactSweep> two;
    two.push_back(plm::sweep_contact(numbers({1, -1}), true, numbers({1, 1})));    // .. x. xx
    two.push_back(plm::sweep_contact(numbers({1, -1}), true, numbers({-1, 0.5}))); // x. .. .x
    const auto samples = plm::select_samples(two, 10, true, true, false);
    assert_string_equal(text(samples).c_str(), ".. x. xx .x");
    assert_int_equal(samples[3].dominant, 1);
}

// Five sets, the one at rest in the middle: it takes the place of the later of the two beside it.
void the_set_at_rest_takes_the_nearest_place(void **) {
    const std::vector<ContactSweep> one(
        1, plm::sweep_contact(numbers({2, 1, -1, -2}), true, numbers({1, 1, 1, 1})));
    assert_string_equal(text(plm::select_samples(one, 2, false, false, false)).c_str(), "x... xxx.");
    assert_string_equal(text(plm::select_samples(one, 2, false, false, true)).c_str(), "x... xx..");
    assert_string_equal(text(plm::select_samples(one, 3, true, false, true)).c_str(), ".... xx.. xxxx");
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_are_equally_spaced),
        cmocka_unit_test(complements_come_after_and_only_when_new),
        cmocka_unit_test(the_set_at_rest_takes_the_nearest_place),
        cmocka_unit_test(several_dominant_modes_share_their_samples),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
