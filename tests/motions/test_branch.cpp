// What a branch holds and tells, against closed forms: mean energies of a motion, points joined to a curve,
// the number of points that may be.
#include "motions/branch.hpp"
#include "motions/branch_path.hpp"
#include "motions/motion_measures.hpp"
#include "paths/continuation.hpp"
#include "support/line.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"

namespace {

std::shared_ptr<plm::ReducedModel> oscillator() {
    return test::reduce_exactly(test::bilinear_oscillator(0.05, 0.5, 1, 1, 0));
}

plm::BranchPoint point(double omega, double arclength, std::int64_t n_harmonics) {
    plm::BranchPoint p;
    p.omega = omega, p.arclength = arclength;
    p.eta_0 = {0};
    p.n_harmonics = n_harmonics;
    p.eta.reset(1, 2 * n_harmonics);
    for (std::int64_t h = 1; h <= n_harmonics; ++h) p.eta(0, 2 * h - 1) = 1 / static_cast<double>(h);
    return p;
}

// x = sin(w t / m) + sin(2 w t / m) / 2 of a unit mass on a unit spring, without contact: <v^2> / 2 is
// (w / m)^2 (1 + 1) / 4, <x^2> / 2 is (1 + 1/4) / 4.
void energies_are_means_over_the_period(void **) {
    const auto m = oscillator();
    for (double omega : {0.5, 3.0})
        for (std::int64_t multiple : {1, 3}) {
            const plm::MotionMeasures e = plm::measure_motion(*m, point(omega, 0, 2), multiple);
            assert_true(close_to(e.kinetic, 0.5 * std::pow(omega / static_cast<double>(multiple), 2), 1e-14));
            assert_true(close_to(e.strain, 0.3125, 1e-14));
        }
}

// A piece begins with the point that the curve ends with.
void a_curve_goes_on_with_a_piece(void **) {
    plm::Branch curve(oscillator(), 1), piece(oscillator(), 1);
    for (double s : {0.0, 2.0}) curve.append(point(1 + s, s, 1));
    for (double s : {0.0, 1.0, 4.0}) piece.append(point(3 + s, s, 2));
    curve.continue_with(piece);
    const double omega[] = {1, 3, 4, 7}, arclength[] = {0, 2, 3, 6};
    assert_int_equal(curve.points().size(), 4);
    assert_int_equal(curve.n_harmonics(), 2);
    for (std::size_t k = 0; k < 4; ++k) {
        assert_true(curve.points()[k].omega == omega[k] && curve.points()[k].arclength == arclength[k]);
        assert_int_equal(curve.points()[k].eta.cols(), 4);
    }
}

// The path x = p as a curve with these options.
struct Counting final : plm::PathOwner {
    void record(const plm::PathPoint &) override { ++n; }
    bool cancelled(double) override { return false; }
    bool rescue(double, plm::vector<double> &) override { return false; }
    void test(const plm::vector<double> &, double, plm::vector<double> &) override {}
    plm::vector<std::int32_t> test_kinds() const override { return {}; }
    std::int64_t n = 0;
};
void a_curve_has_no_more_points_than_it_may(void **) {
    plm::MotionOptions options;
    for (std::int64_t most : {2, 5}) {
        options.max_points = most;
        test::Line line;
        Counting owner;
        plm::PathOptions path = plm::path_options(options, 1, 2);
        path.upward = true;
        const plm::PathOutcome out = plm::follow_path(line, path, {{{1}, 1}}, owner);
        assert_int_equal(out.end_reason, plm::reason::point_limit);
        assert_int_equal(owner.n, most);
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(energies_are_means_over_the_period),
        cmocka_unit_test(a_curve_goes_on_with_a_piece),
        cmocka_unit_test(a_curve_has_no_more_points_than_it_may),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
