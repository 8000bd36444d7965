// The continuation on curves that are known, with one unknown x: at corners, on the flank of a resonance, at
// the end of its range, and what it does with test functions of the path's owner.
#include "linalg/error.hpp"
#include "paths/continuation.hpp"
#include "paths/metric.hpp"
#include "support/test.hpp"
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

namespace {

using plm::vector;

// R = p - phi(x).
class KnownCurve : public plm::Residual {
  public:
    using Function = std::function<double(double)>;
    KnownCurve(Function phi, Function slope) : phi_(std::move(phi)), slope_(std::move(slope)) {}
    std::int64_t size() const override { return 1; }
    void residual(const double *x, double p, double *r) override { r[0] = p - phi_(x_ = x[0]); }
    void linearize() override { tangent_ = -slope_(x_); }
    void solve(double *b, std::int64_t n) override {
        for (std::int64_t i = 0; i < n; ++i) b[i] /= tangent_;
    }
    int determinant_sign() const override { return tangent_ < 0 ? -1 : 1; }
    void parameter_derivative(double *r) override { r[0] = 1; }
    double residual_scale() const override { return 1; }

  protected:
    double x_ = 0, tangent_ = 1;

  private:
    Function phi_, slope_;
};

// R = (x - f(p)) (x - f(p) - other): a curve with another one beside it, or alone.
class Response : public plm::Residual {
  public:
    using Function = std::function<double(double)>;
    Response(Function f, Function slope, double other = 0)
        : f_(std::move(f)), slope_(std::move(slope)), other_(other) {}
    std::int64_t size() const override { return 1; }
    void residual(const double *x, double p, double *r) override {
        p_ = p, beside_ = x[0] - f_(p);
        r[0] = other_ == 0 ? beside_ : beside_ * (beside_ - other_);
    }
    void linearize() override { tangent_ = by_beside(); }
    void solve(double *b, std::int64_t n) override {
        for (std::int64_t i = 0; i < n; ++i) b[i] /= tangent_;
    }
    int determinant_sign() const override { return tangent_ < 0 ? -1 : 1; }
    void parameter_derivative(double *r) override { r[0] = -slope_(p_) * by_beside(); }
    double residual_scale() const override { return 1; }
    bool is_cheap_to_linearize() const override { return true; }

  private:
    double by_beside() const { return other_ == 0 ? 1 : 2 * beside_ - other_; }
    Function f_, slope_;
    double other_, p_ = 0, beside_ = 0, tangent_ = 1;
};

// A circle of radius 0.3 about (0, 1/2).
class Circle : public plm::Residual {
  public:
    std::int64_t size() const override { return 1; }
    void residual(const double *x, double p, double *r) override {
        x_ = x[0], p_ = p - 0.5;
        r[0] = x_ * x_ + p_ * p_ - 0.09;
    }
    void linearize() override { by_x_ = 2 * x_, by_p_ = 2 * p_; }
    void solve(double *b, std::int64_t n) override {
        for (std::int64_t i = 0; i < n; ++i) b[i] /= by_x_;
    }
    int determinant_sign() const override { return by_x_ < 0 ? -1 : 1; }
    void parameter_derivative(double *r) override { r[0] = by_p_; }
    double residual_scale() const override { return 1; }

  private:
    double x_ = 0, p_ = 0, by_x_ = 1, by_p_ = 0;
};

class Owner final : public plm::PathOwner {
  public:
    explicit Owner(std::function<double(double)> test = nullptr) : test_(std::move(test)) {}
    void record(const plm::PathPoint &p) override {
        ++n_points;
        if (!p.x.empty()) heights.push_back(p.x[0]);
        all_whole = all_whole && p.x.size() == 1;
        if (p.bifurcation == plm::bifurcation::neimark_sacker) ++n_changes, change = p.parameter;
        if (p.bifurcation != plm::bifurcation::fold) return;
        ++n_folds;
        fold = p.parameter;
    }
    bool cancelled(double) override { return false; }
    bool interrupt() override { return legs_of > 0 && ++n_steps % legs_of == 0; }
    bool rescue(double, vector<double> &) override { return false; }
    void test(const vector<double> &, double p, vector<double> &values) override {
        ++n_looks;
        if (test_) values = {test_(p)};
    }
    vector<std::int32_t> test_kinds() const override {
        if (!test_) return {};
        return {plm::bifurcation::neimark_sacker};
    }
    int n_points = 0, n_folds = 0, n_changes = 0, n_looks = 0;
    int legs_of = 0, n_steps = 0; // interrupted after so many
    double fold = 0, change = 0;
    bool all_whole = true;
    std::vector<double> heights; // x of each point
    int n_between(double low, double high) const {
        int n = 0;
        for (double x : heights) n += x > low && x < high;
        return n;
    }

  private:
    std::function<double(double)> test_;
};

struct Followed {
    plm::PathOutcome out;
    Owner owner;
};
Followed follow(plm::Residual &curve, plm::PathStart start = {{{0}, 0}}, const Owner &owner = Owner()) {
    plm::PathOptions options;
    options.low = 0;
    options.high = 1;
    options.upward = true;
    options.locate = true;
    options.max_points = 500;
    Followed f{{}, owner};
    f.out = plm::follow_path(curve, options, start, f.owner);
    return f;
}

// Round the circle in legs: by one system, or each by one of its own, made of a path's progress alone.
Owner in_legs(int steps, bool anew) {
    plm::PathOptions options;
    options.low = 0, options.high = 1, options.upward = true, options.locate = true;
    Owner owner;
    owner.legs_of = steps;
    auto circle = std::make_unique<Circle>();
    plm::PathOutcome out = plm::follow_path(*circle, options, {{{0.3}, 0.5}}, owner);
    while (out.end_reason == plm::reason::none) {
        const plm::PathProgress kept = out;
        if (anew) circle = std::make_unique<Circle>();
        out = plm::go_on_with_path(*circle, options, kept, owner);
    }
    owner.change = out.end_reason;
    return owner;
}

// To the last bit; and the loop is closed at the first start, which no leg but the first has seen.
void a_path_goes_on_with_the_points_it_would_have_had(void **) {
    for (int steps : {1, 3, 10}) {
        const Owner one = in_legs(steps, false), other = in_legs(steps, true);
        assert_true(one.heights == other.heights && one.heights.size() > 20);
        assert_int_equal(static_cast<int>(one.change), plm::reason::loop_closed);
        assert_int_equal(one.n_folds, 2);
    }
}

void a_path_of_another_system_does_not_go_on(void **) {
    Circle circle;
    Owner owner;
    plm::PathProgress two;
    two.at = two.direction = two.target = two.target_direction = {{0.3, 0}, 0.5};
    two.scale = 1;
    try {
        plm::go_on_with_path(circle, plm::PathOptions(), two, owner);
        fail();
    } catch (const plm::Error &e) {
        assert_int_equal(e.status(), plm::status::argument);
    }
}

// Up to p = 1/2 the line p = x; beyond it p falls three times as fast: a turn of more than a right angle,
// after which the direction nearer to the old one leads back to the start.
double corner(double x) {
    return x < 0.5 ? x : 0.5 - 3 * (x - 0.5);
}
double corner_slope(double x) {
    return x < 0.5 ? 1 : -3;
}
// The same with a grazing touch: the slope falls like the square root of the way beyond 1/2, and is zero
// 4e-15 from there, nearer than any step; p = 0 again where x = c (x - 1/2)^(3/2).
constexpr double c = 1e7;
double grazing(double x) {
    return x < 0.5 ? x : x - c * std::pow(x - 0.5, 1.5);
}
double grazing_slope(double x) {
    return x < 0.5 ? 1 : 1 - 1.5 * c * std::sqrt(x - 0.5);
}
double grazing_end() {
    double x = 0.5;
    for (int k = 0; k < 50; ++k) x = 0.5 + std::pow(x / c, 2.0 / 3);
    return x;
}

void a_corner_beyond_a_right_angle_is_followed(void **) {
    KnownCurve curve(corner, corner_slope);
    const Followed f = follow(curve);
    assert_int_equal(f.out.end_reason, plm::reason::range_end);
    assert_true(near(f.out.at.x[0], 2.0 / 3, 1e-9));
    assert_true(f.out.direction.parameter < 0);
}

// From a point beside it the path steps onto the circle, which it would go round for ever.
void a_path_that_comes_by_a_point_of_its_own_ends(void **) {
    Circle circle;
    const Followed f = follow(circle, {{{0.312}, 0.5}});
    assert_int_equal(f.out.end_reason, plm::reason::crossed_over);
    assert_true(f.out.arclength > 1.5 && f.owner.n_points < 100);
}

// From a point of its own it comes back to that.
void a_closed_path_comes_back_to_its_start(void **) {
    Circle circle;
    const Followed f = follow(circle, {{{0.3}, 0.5}});
    assert_int_equal(f.out.end_reason, plm::reason::loop_closed);
}

void a_corner_at_which_the_parameter_turns_is_a_fold(void **) {
    KnownCurve curve(corner, corner_slope);
    const Followed f = follow(curve);
    assert_int_equal(f.owner.n_folds, 1);
    assert_true(near(f.owner.fold, 0.5, 1e-6)); // to a few of the smallest steps
}

void a_grazing_corner_is_passed_whatever_the_smallest_step(void **) {
    KnownCurve curve(grazing, grazing_slope);
    const Followed f = follow(curve);
    assert_int_equal(f.out.end_reason, plm::reason::range_end);
    assert_true(near(f.out.at.x[0], grazing_end(), 1e-9)); // the tolerance of Newton's correction
    assert_true(f.owner.n_points < 150);
}

// A path that goes on, as after a change of the unknowns: the curve began at 0.4 and had left downwards.
void a_path_that_comes_to_its_beginning_from_behind_has_turned_back(void **) {
    KnownCurve curve(corner, corner_slope);
    plm::PathStart start;
    start.at.x = {0};
    start.end = {{0.4}, 0.4};
    start.end_direction = {{-1}, -1};
    const Followed f = follow(curve, start);
    assert_int_equal(f.out.end_reason, plm::reason::turned_back);
    assert_true(f.out.at.x[0] >= 0.4 && f.out.at.x[0] < 0.5);
    start.end_direction = {{1}, 1};
    assert_int_equal(follow(curve, start).out.end_reason, plm::reason::loop_closed);
    start.end.x = {0.48}; // beside the curve: neither
    assert_int_equal(follow(curve, start).out.end_reason, plm::reason::range_end);
}

// The amplitude of an undamped oscillator, beyond whose resonance at p = 1.01 the range does not reach: in
// the end fifty times the static one.
double resonance(double p) {
    return 1 / (1 - p * p / 1.0201);
}
double resonance_slope(double p) {
    return 2 * p / 1.0201 * resonance(p) * resonance(p);
}

// The metric grows with the response, and lengths of steps are those of the metric of now: a curve that grows
// a hundredfold on a flank takes steps of 0.15 there, too (with a tangent of the metric before: 131 points).
void the_flank_of_a_resonance_takes_few_points(void **) {
    Response curve(resonance, resonance_slope);
    const Followed f = follow(curve, {{{1}, 0}});
    assert_int_equal(f.out.end_reason, plm::reason::range_end);
    assert_true(f.owner.n_points < 50);
}

// A curve that bends up to the end of its range beside another one: what the last step comes upon there, from
// its chord, is the other one. It is tried shorter.
void the_last_point_belongs_to_the_curve(void **) {
    Response curve([](double p) { return std::pow(p, 8); }, [](double p) { return 8 * std::pow(p, 7); },
                   3e-3);
    const Followed f = follow(curve);
    assert_int_equal(f.out.end_reason, plm::reason::range_end);
    assert_true(near(f.out.at.x[0], 1, 1e-9));
}

// Below zero between p = 0.49 and 0.51, a fifth of the steps on a straight line.
void a_test_function_that_dips_is_not_stepped_over(void **) {
    KnownCurve line([](double x) { return x; }, [](double) { return 1; });
    const Followed f = follow(line, {{{0}, 0}}, Owner([](double p) { return std::abs(p - 0.5) - 0.01; }));
    assert_int_equal(f.out.end_reason, plm::reason::range_end);
    assert_int_equal(f.owner.n_changes, 2);
}

// A product over multipliers may overflow where a motion is very unstable. (A point without unknowns was
// recorded.)
void a_test_function_that_is_infinite_has_no_zero(void **) {
    KnownCurve line([](double x) { return x; }, [](double) { return 1; });
    const Followed f =
        follow(line, {{{0}, 0}}, Owner([](double p) { return p < 0.3 ? INFINITY : -INFINITY; }));
    assert_int_equal(f.out.end_reason, plm::reason::range_end);
    assert_int_equal(f.owner.n_changes, 0);
    assert_true(f.owner.all_whole);
}

// Not known at one of the path's points: a change of sign behind that is one from the last known value.
void a_test_function_that_is_not_known_keeps_its_sign(void **) {
    KnownCurve line([](double x) { return x; }, [](double) { return 1; });
    const auto gap = [](double p) { return p > 0.22 && p < 0.32 ? NAN : p - 0.36; };
    const Followed f = follow(line, {{{0}, 0}}, Owner(gap));
    assert_int_equal(f.out.end_reason, plm::reason::range_end);
    assert_int_equal(f.owner.n_between(0.22, 0.32), 1);
    assert_int_equal(f.owner.n_between(0.32, 0.355), 0); // the next one lies beyond the zero
    assert_int_equal(f.owner.n_changes, 1);
    assert_true(near(f.owner.change, 0.36, 1e-8));
}

// A cliff of fifty times the height so far, narrower than any step: the plane across a step that went beyond
// it meets the curve above, which is no neighbour of the last point. The path climbs.
void a_correction_far_beyond_its_step_is_no_step(void **) {
    constexpr double width = 1e-3;
    Response cliff([](double p) { return 1 + 25 * (1 + std::tanh((p - 0.5) / width)); },
                   [](double p) { return 25 / width / std::pow(std::cosh((p - 0.5) / width), 2); });
    const Followed f = follow(cliff, {{{1}, 0}});
    assert_int_equal(f.out.end_reason, plm::reason::range_end);
    assert_true(near(f.out.at.x[0], 51, 1e-9));
    assert_true(f.owner.n_between(2, 50) >= 3);
}

// Each look is a solution and a tangent. A smooth function has its zero after a few, one that begins with a
// root by bisection, and one that jumps is left soon.
int looks_for_zero(const std::function<double(double)> &test, int n_changes, double error) {
    KnownCurve line([](double x) { return x; }, [](double) { return 1; });
    const Followed f = follow(line, {{{0}, 0}}, Owner(test)),
                   plain = follow(line, {{{0}, 0}}, Owner([](double) { return 1.0; }));
    assert_int_equal(f.owner.n_changes, n_changes);
    if (n_changes > 0) assert_true(near(f.owner.change, 0.537, error));
    return f.owner.n_looks - plain.owner.n_looks;
}
void a_special_point_takes_few_looks(void **) {
    const auto root = [](double p) { return std::copysign(std::sqrt(std::abs(p - 0.537)), p - 0.537); };
    const int smooth =
                  looks_for_zero([](double p) { return std::exp(9 * p) - std::exp(9 * 0.537); }, 1, 1e-8),
              steep = looks_for_zero(root, 1, 1e-4),
              jump = looks_for_zero([](double p) { return p < 0.537 ? -1.0 : 1.0; }, 0, 0);
    std::printf("    %d looks, %d at a root, %d at a jump\n", smooth, steep, jump);
    assert_true(smooth <= 8 && steep <= 40 && jump <= 20);
}

// Of a matrix that is singular but for 1e-6: inverse iteration has its direction to the sixth power of that.
class NearlySingular final : public Circle {
  public:
    std::int64_t size() const override { return 2; }
    void solve(double *b, std::int64_t n) override {
        for (std::int64_t i = 0; i < n; ++i) { // [1 1; 1 1 + 1e-6]
            double *x = b + 2 * i;
            const double second = (x[1] - x[0]) / 1e-6;
            x[0] -= second, x[1] = second;
        }
    }
};
void the_null_direction_is_that_of_the_smallest_value(void **) {
    NearlySingular system;
    const vector<double> v = plm::null_direction(system);
    assert_true(near(std::abs(v[0]), std::sqrt(0.5), 1e-6) && near(v[0] + v[1], 0, 1e-6));
}

// One that may keep where it stands, and counts its tangents but for those of Newton's method.
class Remembering final : public KnownCurve {
  public:
    explicit Remembering(bool remembers)
        : KnownCurve([](double x) { return x + x * x * x; }, [](double x) { return 1 + 3 * x * x; }),
          remembers_(remembers) {}
    void linearize() override {
        ++n_tangents;
        KnownCurve::linearize();
    }
    plm::Tangent linearize_roughly() override {
        KnownCurve::linearize();
        return plm::Tangent::rough;
    }
    bool is_cheap_to_linearize() const override { return true; }
    void remember() override { kept_x_ = x_, kept_tangent_ = tangent_; }
    bool recall() override {
        if (remembers_) x_ = kept_x_, tangent_ = kept_tangent_;
        return remembers_;
    }
    int n_tangents = 0;

  private:
    bool remembers_;
    double kept_x_ = 0, kept_tangent_ = 1;
};
struct Work {
    int tangents = 0, looks = 0, points = 0;
    double end = 0;
};
Work work_for_zero(bool remembers, bool any_zero) {
    Remembering curve(remembers);
    const Followed f = follow(curve, {{{0}, 0}},
                              Owner([any_zero](double p) { return any_zero ? std::sinh(p - 0.537) : 1.0; }));
    return {curve.n_tangents, f.owner.n_looks, f.owner.n_points, f.out.at.x[0]};
}
// Each look takes a tangent. The point found is the last place looked at, and the end of the step is known.
void nothing_is_linearised_twice_beside_a_special_point(void **) {
    const Work plain = work_for_zero(true, false), known = work_for_zero(true, true),
               anew = work_for_zero(false, true);
    assert_int_equal(known.points, plain.points + 1);
    assert_int_equal(known.tangents - plain.tangents, known.looks - plain.looks);
    assert_int_equal(anew.tangents, known.tangents + 1);
    assert_true(near(known.end, anew.end, 1e-12) && near(known.end, plain.end, 1e-9));
}

// A guess stands in for the tangent until it leads nowhere: near the truth it serves for every correction,
// and with the wrong sign it costs one look and the tangent itself.
class Guessing final : public KnownCurve {
  public:
    explicit Guessing(double factor)
        : KnownCurve([](double x) { return x + x * x * x; }, [](double x) { return 1 + 3 * x * x; }),
          factor_(factor) {}
    plm::Tangent linearize_roughly() override {
        KnownCurve::linearize();
        if (n_tangents++ > 0) return plm::Tangent::exact;
        tangent_ *= factor_;
        return plm::Tangent::guessed;
    }
    bool is_cheap_to_linearize() const override { return true; }
    int n_tangents = 0;

  private:
    double factor_;
};
struct Solved {
    double x = 0;
    std::int64_t tangents = 0;
    bool converged = false;
};
Solved solved_from_guess(double factor, double start) {
    Guessing curve(factor);
    vector<double> x = {start};
    plm::NewtonLimits limits;
    const plm::NewtonOutcome out = plm::newton_at(curve, limits, x, 2.0);
    return {x[0], curve.n_tangents, out.converged};
}
void a_guessed_tangent_leads_no_longer_than_it_helps(void **) {
    const Solved near_it = solved_from_guess(1.02, 1 + 1e-7), wrong = solved_from_guess(-1, 0.7);
    for (const Solved &s : {near_it, wrong}) {
        assert_true(s.converged);
        assert_true(near(s.x, 1, 1e-9)); // 1 + 1^3 = 2; the tolerance asked for
    }
    assert_int_equal(near_it.tangents, 1);
    assert_true(wrong.tangents > 1);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_corner_beyond_a_right_angle_is_followed),
        cmocka_unit_test(a_path_that_comes_by_a_point_of_its_own_ends),
        cmocka_unit_test(a_closed_path_comes_back_to_its_start),
        cmocka_unit_test(a_corner_at_which_the_parameter_turns_is_a_fold),
        cmocka_unit_test(a_grazing_corner_is_passed_whatever_the_smallest_step),
        cmocka_unit_test(a_path_that_comes_to_its_beginning_from_behind_has_turned_back),
        cmocka_unit_test(the_flank_of_a_resonance_takes_few_points),
        cmocka_unit_test(the_last_point_belongs_to_the_curve),
        cmocka_unit_test(a_test_function_that_dips_is_not_stepped_over),
        cmocka_unit_test(a_test_function_that_is_infinite_has_no_zero),
        cmocka_unit_test(a_test_function_that_is_not_known_keeps_its_sign),
        cmocka_unit_test(a_correction_far_beyond_its_step_is_no_step),
        cmocka_unit_test(a_special_point_takes_few_looks),
        cmocka_unit_test(nothing_is_linearised_twice_beside_a_special_point),
        cmocka_unit_test(a_guessed_tangent_leads_no_longer_than_it_helps),
        cmocka_unit_test(the_null_direction_is_that_of_the_smallest_value),
        cmocka_unit_test(a_path_goes_on_with_the_points_it_would_have_had),
        cmocka_unit_test(a_path_of_another_system_does_not_go_on),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
