// What a path tells of where it stands: the points it came by, the end of its range, how far it is.
#include "paths/continuation.hpp"
#include "paths/passed_points.hpp"
#include "support/line.hpp"
#include "support/test.hpp"

namespace {

using plm::PathState;

// A step along p from 0 to 1 comes by a point at 1/2 that was left in the same direction, and by no other.
std::int64_t passed(const PathState &point, const PathState &left_in) {
    const plm::Metric metric;
    plm::PassedPoints points(1);
    points.add(metric, point, left_in);
    return points.on_step(metric, {{0}, 0}, {{0}, 1}, {{0}, 1});
}
void a_point_on_the_step_is_passed(void **) {
    const PathState along{{0}, 1};
    assert_int_equal(passed({{0}, 0.5}, along), 0);
    assert_int_equal(passed({{0}, 0.5}, {{0}, -1}), -1);
    assert_int_equal(passed({{0}, 1.5}, along), -1);
    assert_int_equal(passed({{0}, -0.5}, along), -1);
    assert_int_equal(passed({{0.5}, 0.5}, along), -1);
}

class Watching final : public plm::PathOwner {
  public:
    void record(const plm::PathPoint &p) override { last = p.parameter; }
    bool cancelled(double share) override {
        grows = grows && share >= done;
        done = share;
        return false;
    }
    bool rescue(double, plm::vector<double> &) override { return false; }
    void test(const plm::vector<double> &, double, plm::vector<double> &) override {}
    plm::vector<std::int32_t> test_kinds() const override { return {}; }
    double last = -1, done = 0;
    bool grows = true;
};
// Of a range of 20 both ways, by steps of no more than a tenth of it.
Watching watched(bool upward) {
    test::Line line;
    plm::PathOptions options;
    options.low = 30, options.high = 50;
    options.upward = upward;
    options.max_points = 500;
    options.max_step = 0.1;
    const double from = upward ? options.low : options.high;
    Watching owner;
    plm::follow_path(line, options, {{{from}, from}}, owner);
    return owner;
}
void the_end_of_the_range_is_a_point(void **) {
    assert_true(near(watched(true).last, 50, 1e-12));
    assert_true(near(watched(false).last, 30, 1e-12));
}
void the_share_that_is_done_grows_to_one(void **) {
    for (bool upward : {true, false}) {
        const Watching owner = watched(upward);
        assert_true(owner.grows && owner.done > 0.8 && owner.done < 1);
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_point_on_the_step_is_passed),
        cmocka_unit_test(the_end_of_the_range_is_a_point),
        cmocka_unit_test(the_share_that_is_done_grows_to_one),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
