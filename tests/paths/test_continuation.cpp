// The continuation at corners, on curves that are known: one unknown x, the parameter p = phi(x).
#include "paths/continuation.hpp"
#include "support/test.hpp"
#include <functional>

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

class Owner final : public plm::PathOwner {
  public:
    void record(const plm::PathPoint &p) override {
        ++n_points;
        if (p.bifurcation != PLM_BIFURCATION_FOLD) return;
        ++n_folds;
        fold = p.parameter;
    }
    bool cancelled(double) override { return false; }
    bool rescue(double, vector<double> &) override { return false; }
    int n_points = 0, n_folds = 0;
    double fold = 0;
};

struct Followed {
    plm::PathOutcome out;
    Owner owner;
};
Followed follow(KnownCurve &curve, plm::PathStart start = {{{0}, 0}}) {
    plm::PathOptions options;
    options.low = 0;
    options.high = 1;
    options.upward = true;
    options.locate = true;
    options.max_points = 500;
    Followed f;
    f.out = plm::follow_path(curve, options, start, f.owner);
    return f;
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
    assert_int_equal(f.out.end_reason, PLM_REASON_RANGE_END);
    assert_true(near(f.out.at.x[0], 2.0 / 3, 1e-9));
    assert_true(f.out.direction.parameter < 0);
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
    assert_int_equal(f.out.end_reason, PLM_REASON_RANGE_END);
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
    assert_int_equal(f.out.end_reason, PLM_REASON_TURNED_BACK);
    assert_true(f.out.at.x[0] >= 0.4 && f.out.at.x[0] < 0.5);
    start.end_direction = {{1}, 1};
    assert_int_equal(follow(curve, start).out.end_reason, PLM_REASON_LOOP_CLOSED);
    start.end.x = {0.48}; // beside the curve: neither
    assert_int_equal(follow(curve, start).out.end_reason, PLM_REASON_RANGE_END);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_corner_beyond_a_right_angle_is_followed),
        cmocka_unit_test(a_corner_at_which_the_parameter_turns_is_a_fold),
        cmocka_unit_test(a_grazing_corner_is_passed_whatever_the_smallest_step),
        cmocka_unit_test(a_path_that_comes_to_its_beginning_from_behind_has_turned_back),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
