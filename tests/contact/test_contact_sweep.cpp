// The sweep of the contact area against sweeps worked out by hand.
#include "contact/contact_sweep.hpp"
#include "support/sweeps.hpp"
#include "support/test.hpp"

using plm::ContactSweep;

namespace {

using test::numbers;
using test::text;

std::string text(const ContactSweep &sweep) {
    std::string s;
    for (const auto &sample : sweep.samples) s += (s.empty() ? "" : " ") + text(sample);
    return s;
}

// Every representative alpha reproduces its contact set by plain evaluation of eq. (5).
bool alphas_reproduce(const ContactSweep &sweep, const plm::vector<double> &dv) {
    for (std::size_t s = 0; s < sweep.samples.size(); ++s)
        for (std::size_t i = 0; i < dv.size(); ++i)
            if ((sweep.offset[i] + sweep.alpha[s] * dv[i] > 0) != sweep.samples[s].is_closed(i)) return false;
    return true;
}

void distinct_thresholds_give_z_plus_1_samples(void **) {
    // dX = (1 + a, -1 + a, 0.5 - a): switches at -1, 1 and 0.5
    const auto dv = numbers({1, 1, -1});
    const ContactSweep sweep = plm::sweep_contact(numbers({1, -1, 0.5}), true, dv);
    assert_string_equal(text(sweep).c_str(), "..x x.x x.. xx.");
    assert_int_equal(sweep.thresholds.size(), 3);
    assert_true(near(sweep.thresholds[0], -1, 1e-15) && near(sweep.thresholds[1], 0.5, 1e-15) &&
                near(sweep.thresholds[2], 1, 1e-15));
    assert_int_equal(sweep.switching[1][0], 2);
    assert_true(near(sweep.alpha[0], -1.1, 1e-15)); // 5 % of the range beyond the first
    assert_true(near(sweep.alpha[1], -0.25, 1e-15));
    assert_true(near(sweep.alpha[3], 1.1, 1e-15));
    assert_true(alphas_reproduce(sweep, dv));
}

void ties_are_one_threshold(void **) {
    // pairs 0 and 2 mirror each other up to rounding, pair 1 closes where pair 3 opens
    const auto dv = numbers({1, 2, 1, -2});
    const ContactSweep sweep = plm::sweep_contact(numbers({1, -2, 1 + 1e-13, 2}), true, dv);
    assert_int_equal(sweep.thresholds.size(), 2);
    assert_string_equal(text(sweep).c_str(), "...x x.xx xxx.");
    assert_int_equal(sweep.switching[0].size(), 2);
    assert_true(alphas_reproduce(sweep, dv));
}

// A crack with its mirror image, each pair off by `asymmetry` of its twin's threshold: as many samples as the
// half has, and twins closed together in all of them. 1e-5 apart they are two pairs.
ContactSweep mirrored(double asymmetry) {
    plm::vector<double> offset, dv;
    for (int i = 0; i < 20; ++i)
        for (int side = -1; side <= 1; side += 2) {
            dv.push_back(1 + 0.3 * std::cos(2.0 * i));
            offset.push_back((std::sin(1.0 + i * i) - 0.2) * dv.back() * (1 + 0.5 * side * asymmetry));
        }
    return plm::sweep_contact(offset, true, dv);
}
int torn_twins(const ContactSweep &sweep) {
    int torn = 0;
    for (const auto &sample : sweep.samples)
        for (std::int64_t i = 0; i < sample.size(); i += 2)
            torn += sample.is_closed(i) != sample.is_closed(i + 1);
    return torn;
}
void twins_of_a_nearly_symmetric_mesh_switch_together(void **) {
    for (double asymmetry : {0.0, 1e-12, 1e-9, 1e-8, 1e-7, 5e-7}) {
        const ContactSweep sweep = mirrored(asymmetry);
        assert_int_equal(sweep.samples.size(), 21);
        assert_int_equal(torn_twins(sweep), 0);
    }
    assert_int_equal(mirrored(1e-4).samples.size(), 41);
}

void a_pair_that_hardly_moves_does_not_blur_the_others(void **) {
    // pair 2 switches at alpha = -1e8: 1e-9 of the range would be 0.1
    const ContactSweep sweep = plm::sweep_contact(numbers({1, 1.01, 1}), true, numbers({1, 1, 1e-8}));
    assert_int_equal(sweep.thresholds.size(), 3);
    assert_string_equal(text(sweep).c_str(), "... ..x .xx xxx");
}

void motionless_pairs_never_switch(void **) {
    const ContactSweep sweep =
        plm::sweep_contact(numbers({1, -1, 0, 0.3}), true, numbers({1e-10, 1e-12, 0, 1}));
    assert_int_equal(sweep.thresholds.size(), 1);
    assert_string_equal(text(sweep).c_str(), "x... x..x");
    const ContactSweep still = plm::sweep_contact(numbers({1, -1}), true, numbers({0, 0}));
    assert_int_equal(still.thresholds.size(), 0);
    assert_string_equal(text(still).c_str(), "x.");
    assert_int_equal(still.alpha.size(), 1);
}

void without_offset_all_pairs_switch_at_once(void **) {
    const ContactSweep sweep = plm::sweep_contact(numbers({0, 0, 0}), false, numbers({1, -2, 3}));
    assert_string_equal(text(sweep).c_str(), ".x. x.x");
    assert_true(sweep.alpha[0] < 0 && sweep.alpha[1] > 0);
}

void many_pairs_give_z_plus_1_samples_each_one_switch_apart(void **) {
    plm::vector<double> offset, dv;
    for (int i = 0; i < 90; ++i) {
        offset.push_back(std::sin(1.0 + i * i));
        dv.push_back(std::cos(3.0 * i) + 0.01);
    }
    const ContactSweep sweep = plm::sweep_contact(offset, true, dv);
    int wrong = 0;
    for (std::size_t s = 1; s < sweep.samples.size(); ++s)
        wrong += sweep.samples[s].n_different(sweep.samples[s - 1]) != 1;
    assert_int_equal(sweep.samples.size(), 91);
    assert_int_equal(wrong, 0);
    assert_true(alphas_reproduce(sweep, dv));
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distinct_thresholds_give_z_plus_1_samples),
        cmocka_unit_test(ties_are_one_threshold),
        cmocka_unit_test(twins_of_a_nearly_symmetric_mesh_switch_together),
        cmocka_unit_test(a_pair_that_hardly_moves_does_not_blur_the_others),
        cmocka_unit_test(motionless_pairs_never_switch),
        cmocka_unit_test(without_offset_all_pairs_switch_at_once),
        cmocka_unit_test(many_pairs_give_z_plus_1_samples_each_one_switch_apart),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
