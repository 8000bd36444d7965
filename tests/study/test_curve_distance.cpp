// Distances of curves against closed forms: circles, a curve with folds and its parallel curve; the Pareto
// front of points placed by hand.
#include "study/curve_distance.hpp"
#include "study/pareto.hpp"
#include "support/test.hpp"
#include <limits>

namespace {

using plm::PlanePiece;
using plm::PlanePoint;

/// Pieces of a curve (x, y)(t) with derivatives.
template <class Curve> plm::vector<PlanePiece> pieces_of(Curve curve, double first, double last, int n) {
    plm::vector<PlanePiece> pieces;
    const auto direction = [&](double t) {
        const PlanePoint d = curve.slope(t);
        const double length = std::hypot(d.x, d.y);
        return PlanePoint{d.x / length, d.y / length};
    };
    for (int i = 0; i < n; ++i) {
        const double a = first + (last - first) * i / n, b = first + (last - first) * (i + 1) / n;
        pieces.push_back({curve.at(a), curve.at(b), direction(a), direction(b)});
    }
    return pieces;
}

struct Circle {
    double radius, x = 0;
    PlanePoint at(double t) const { return {x + radius * std::cos(t), radius * std::sin(t)}; }
    PlanePoint slope(double t) const { return {-radius * std::sin(t), radius * std::cos(t)}; }
};

/// x = y^3 - y has two folds; the curve beside it at a constant distance along the normal.
struct Folded {
    double offset = 0;
    PlanePoint at(double y) const {
        const double s = 3 * y * y - 1, length = std::hypot(s, 1.0);
        return {y * y * y - y + offset / length, y - offset * s / length};
    }
    PlanePoint slope(double y) const {
        const double s = 3 * y * y - 1, cube = std::pow(s * s + 1, 1.5), turn = 6 * y;
        return {s - offset * s * turn / cube, 1 - offset * turn / cube};
    }
};

void concentric_circles_are_the_difference_of_radii_apart(void **) {
    const auto inner = pieces_of(Circle{1}, 0, 2 * M_PI, 48),
               outer = pieces_of(Circle{1.1}, 0.3, 0.3 + 2 * M_PI, 40);
    const plm::CurveDistance d = plm::curve_distance(plm::equally_spaced(inner, 500), outer);
    // arcs of a circle are right to the sixth order: 0.16^6 / 1e4
    assert_true(near(d.rms, 0.1, 1e-8) && near(d.max, 0.1, 1e-8));
}

void a_shifted_circle_is_as_far_as_geometry_says(void **) {
    // from the unit circle to the one with its centre at (e, 0): | sqrt(1 - 2 e cos t + e^2) - 1 |
    const double e = 0.05;
    double squares = 0, largest = 0;
    for (int i = 0; i < 100000; ++i) {
        const double t = 2 * M_PI * i / 100000, d = std::abs(std::sqrt(1 - 2 * e * std::cos(t) + e * e) - 1);
        squares += d * d / 100000, largest = std::max(largest, d);
    }
    const auto one = pieces_of(Circle{1}, 0, 2 * M_PI, 64), other = pieces_of(Circle{1, e}, 0, 2 * M_PI, 64);
    const plm::CurveDistance d = plm::curve_distance(plm::equally_spaced(one, 20001), other);
    assert_true(close_to(d.rms, std::sqrt(squares), 1e-4) && close_to(d.max, largest, 1e-5));
}

void folds_do_not_spoil_it(void **) {
    const auto curve = pieces_of(Folded{0}, -1.2, 1.2, 200);
    for (double offset : {1e-1, 1e-3, 1e-5, -1e-3}) {
        // longer than the curve, so that every normal of the curve meets it
        const auto beside = pieces_of(Folded{offset}, -1.4, 1.4, 260);
        const plm::CurveDistance d = plm::curve_distance(plm::equally_spaced(curve, 400), beside);
        assert_true(near(d.rms, std::abs(offset), 1e-8) && near(d.max, std::abs(offset), 1e-7));
    }
}

void a_piece_is_right_to_the_fourth_order(void **) {
    const auto truth = pieces_of(Folded{0}, -1.2, 1.2, 3000);
    double error[2];
    for (int k = 0; k < 2; ++k) {
        const auto coarse = pieces_of(Folded{0}, -1.2, 1.2, 40 << k);
        error[k] = plm::curve_distance(plm::equally_spaced(coarse, 1000), truth).max;
    }
    assert_true(error[0] < 1e-4 && error[1] < error[0] / 10);
}

void points_are_equally_spaced_and_a_missing_part_counts(void **) {
    const auto half = pieces_of(Circle{2}, 0, M_PI, 7);
    const plm::vector<PlanePoint> points = plm::equally_spaced(half, 101);
    double worst = 0;
    for (int i = 0; i <= 100; ++i) {
        const double angle = M_PI * i / 100;
        worst =
            std::max(worst, std::hypot(points[i].x - 2 * std::cos(angle), points[i].y - 2 * std::sin(angle)));
    }
    assert_true(below(worst, 1e-3)); // 7 cubics over half a circle
    assert_int_equal(points.size(), 101);
    // the quarter from 0 is there, the other quarter is not: its far end is 2 sqrt 2 away
    const auto quarter = pieces_of(Circle{2}, 0, M_PI / 2, 7);
    const plm::CurveDistance d = plm::curve_distance(points, quarter);
    assert_true(close_to(d.max, 2 * std::sqrt(2.0), 1e-3) && d.rms > 0.5);
    assert_true(std::isinf(plm::curve_distance(points, {}).max));
}

void the_front_is_what_no_other_one_beats(void **) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    //                                fast  good  both  slow  tie   tie   failed no error
    const plm::vector<double> time = {1.0, 4.0, 2.0, 5.0, 3.0, 3.0, nan, 0.1},
                              error = {1e-1, 1e-5, 1e-3, 1e-4, 1e-4, 1e-4, 1e-9, nan};
    const plm::vector<char> front = plm::pareto_front(time, error);
    const int want[] = {1, 1, 1, 0, 1, 1, 0, 0};
    for (int i = 0; i < 8; ++i) assert_int_equal(front[i], want[i]);
    assert_true(plm::pareto_front({}, {}).empty());
    const plm::vector<char> same_time = plm::pareto_front({1, 1}, {2, 3}),
                            same_error = plm::pareto_front({1, 2}, {2, 2});
    assert_true(same_time[0] && !same_time[1] && same_error[0] && !same_error[1]);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(concentric_circles_are_the_difference_of_radii_apart),
        cmocka_unit_test(a_shifted_circle_is_as_far_as_geometry_says),
        cmocka_unit_test(folds_do_not_spoil_it),
        cmocka_unit_test(a_piece_is_right_to_the_fourth_order),
        cmocka_unit_test(points_are_equally_spaced_and_a_missing_part_counts),
        cmocka_unit_test(the_front_is_what_no_other_one_beats),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
