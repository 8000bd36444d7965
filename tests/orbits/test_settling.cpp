// A motion has settled when it is back where it was after as many periods as it may have, and not before; the
// phase of what is marched.
#include "orbits/settling.hpp"
#include "orbits/transient.hpp"
#include "support/test.hpp"

namespace {

// Quarters until it says that it has settled, of a motion that goes round once in `span` quarters; -1: never.
int quarters_until_settled(std::int64_t multiple, int span, double drift = 0) {
    plm::Settling settling(1e-6, multiple);
    double begin = 0;
    const auto at = [&](int k) { return std::sin(2 * M_PI * k / span) + drift * k; };
    for (int k = 1; k <= 64; ++k) {
        const bool end_of_span = settling.quarter(std::abs(at(k) - begin));
        if (end_of_span && settling.settled()) return k;
        if (end_of_span) begin = at(k);
    }
    return -1;
}

void a_motion_of_several_periods_is_compared_over_all_of_them(void **) {
    assert_int_equal(quarters_until_settled(1, 4), 4);
    assert_int_equal(quarters_until_settled(2, 8), 8);
    assert_int_equal(quarters_until_settled(3, 12), 12);
    assert_int_equal(quarters_until_settled(4, 8), 16); // twice round is back, too
    assert_int_equal(quarters_until_settled(1, 12), -1);
    assert_int_equal(quarters_until_settled(2, 12), -1);
}

// Of a motion of size 1 that drifts by 1e-3 a quarter: 8e-3 in two periods, over half of the largest distance
// on the way, 1 + 2e-3 (a quarter of a turn) or 1 - 6e-3.
void the_change_is_relative_to_the_motion(void **) {
    plm::Settling settling(1e-6, 2);
    assert_true(settling.change() == -1 && !settling.settled());
    for (int k = 1; k <= 8; ++k)
        assert_int_equal(settling.quarter(std::abs(std::sin(M_PI * k / 4) + 1e-3 * k)), k == 8);
    assert_true(near(settling.change(), 8e-3 / (0.5 * (1 + 2e-3)), 1e-12));
    assert_false(settling.settled());
    assert_int_equal(quarters_until_settled(2, 8, 1e-3), -1);
}

struct Clock final : plm::Transient {
    bool is_reduced() const override { return true; }
    std::int64_t size() const override { return 0; }
    void set_state(const double *, const double *) override {}
    void start_at(const plm::PointStart &) override {}
    void get_state(double *, double *) override {}
    plm::TransientRun run(const plm::TransientOptions &, const plm::vector<std::int64_t> &,
                          plm::Watch) override {
        return {};
    }
    plm::PeriodicMotion find_periodic(const plm::TransientOptions &, plm::Watch) override { return {}; }
    using Transient::advance_clock;
    using Transient::phase;
};

// A part that falls short of the begin of a period by less than the last bit is at it: no phase is 1.
void the_phase_is_below_one(void **) {
    Clock clock;
    clock.advance_clock(3, 0.25 * 2, 2);
    assert_true(clock.phase() == 0.25 && clock.time() == 6.5);
    clock.advance_clock(0, -0.25 * 2, 2);
    clock.advance_clock(0, -1e-18, 2);
    assert_true(clock.phase() == 0);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_motion_of_several_periods_is_compared_over_all_of_them),
        cmocka_unit_test(the_change_is_relative_to_the_motion),
        cmocka_unit_test(the_phase_is_below_one),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
