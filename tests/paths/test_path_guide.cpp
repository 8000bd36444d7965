// A path along a neighbouring one that is known: the same path, with its folds, by fewer and longer steps;
// and as without where the neighbour is none.
#include "paths/continuation.hpp"
#include "paths/path_guide.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using plm::vector;

// A resonance that bends over, of two unknowns: the amplitudes in phase and across, x' = x - i y of
// (1 + |x|^2 - p^2 + 2 i d p) x = force.
class Bent final : public plm::Residual {
  public:
    explicit Bent(double force) : force_(force) {}
    std::int64_t size() const override { return 2; }
    void residual(const double *x, double p, double *r) override {
        a_ = x[0], b_ = x[1], p_ = p;
        r[0] = stiffness() * a_ - loss() * b_ - force_;
        r[1] = loss() * a_ + stiffness() * b_;
    }
    void linearize() override {
        j_[0] = stiffness() + 2 * a_ * a_, j_[1] = loss() + 2 * a_ * b_;
        j_[2] = 2 * a_ * b_ - loss(), j_[3] = stiffness() + 2 * b_ * b_;
    }
    void solve(double *f, std::int64_t n) override {
        const double det = j_[0] * j_[3] - j_[1] * j_[2];
        for (std::int64_t k = 0; k < n; ++k, f += 2) {
            const double first = (f[0] * j_[3] - f[1] * j_[2]) / det;
            f[1] = (f[1] * j_[0] - f[0] * j_[1]) / det;
            f[0] = first;
        }
    }
    int determinant_sign() const override { return j_[0] * j_[3] < j_[1] * j_[2] ? -1 : 1; }
    void parameter_derivative(double *r) override {
        r[0] = -2 * p_ * a_ - 2 * damping * b_;
        r[1] = 2 * damping * a_ - 2 * p_ * b_;
    }
    double residual_scale() const override { return force_; }
    bool is_cheap_to_linearize() const override { return true; }

  private:
    static constexpr double damping = 0.02;
    double stiffness() const { return 1 + a_ * a_ + b_ * b_ - p_ * p_; }
    double loss() const { return 2 * damping * p_; }
    double force_, a_ = 0, b_ = 0, p_ = 1, j_[4] = {1, 0, 0, 1};
};

class Keeper final : public plm::PathOwner {
  public:
    void record(const plm::PathPoint &p) override {
        if (p.bifurcation == plm::bifurcation::fold)
            folds.push_back(p.parameter);
        else
            points.push_back({p.x, p.parameter});
    }
    bool cancelled(double) override { return false; }
    bool rescue(double, vector<double> &) override { return false; }
    std::vector<plm::PathState> points;
    vector<double> folds;
};

struct Followed {
    plm::PathOutcome out;
    Keeper owner;
};

Followed follow(double force, plm::PathGuide *guide) {
    plm::PathOptions options;
    options.low = 0.5, options.high = 2.5;
    options.upward = true;
    options.locate = true;
    options.guide = guide;
    Bent bent(force);
    plm::PathStart start;
    start.at = {{force / 0.75, 0}, options.low};
    plm::newton_at(bent, plm::NewtonLimits(), start.at.x, options.low);
    Followed f;
    f.out = plm::follow_path(bent, options, start, f.owner);
    return f;
}

plm::PathGuide along(const Followed &known, double ratio) {
    const auto &points = known.owner.points;
    return plm::PathGuide(points.size(), [&points, ratio](std::size_t i) {
        plm::PathState state = points[i];
        for (double &x : state.x) x *= ratio;
        return state;
    });
}

double highest(const Followed &f) {
    double most = 0;
    for (const plm::PathState &s : f.owner.points) most = std::max(most, std::hypot(s.x[0], s.x[1]));
    return most;
}

bool same_ends_and_folds(const Followed &a, const Followed &b) {
    const auto &p = a.owner.points.back(), &q = b.owner.points.back();
    bool same = a.out.end_reason == b.out.end_reason && a.owner.folds.size() == b.owner.folds.size() &&
                std::abs(p.parameter - q.parameter) < 1e-12 && std::abs(p.x[0] - q.x[0]) < 1e-9 &&
                std::abs(p.x[1] - q.x[1]) < 1e-9;
    for (std::size_t k = 0; same && k < a.owner.folds.size(); ++k)
        same = std::abs(a.owner.folds[k] - b.owner.folds[k]) < 1e-9;
    return same;
}

// From force to force, each by the one before.
void the_same_path_by_fewer_steps(void **) {
    Followed before = follow(0.1, nullptr);
    assert_int_equal(before.owner.folds.size(), 2);
    double was = 0.1;
    for (double force : {0.09, 0.08, 0.07, 0.06}) {
        plm::PathGuide guide = along(before, force / was);
        const Followed alone = follow(force, nullptr);
        Followed guided = follow(force, &guide);
        std::printf("    force %.2g: %zu points, %lld iterations; alone %zu, %lld\n", force,
                    guided.owner.points.size(), static_cast<long long>(guided.out.work.iterations),
                    alone.owner.points.size(), static_cast<long long>(alone.out.work.iterations));
        assert_true(same_ends_and_folds(guided, alone));
        assert_true(2 * guided.owner.points.size() < alone.owner.points.size());
        assert_int_equal(guided.out.failed_steps, 0); // turns that are foreseen are no corners
        assert_true(guided.out.work.iterations < alone.out.work.iterations);
        assert_true(std::abs(highest(guided) / highest(alone) - 1) < 0.02);
        before = std::move(guided);
        was = force;
    }
}

// Folds that the neighbour has and the path has not, the other way round, a path in the wrong direction, and
// one that is elsewhere.
void a_neighbour_that_is_none_does_no_harm(void **) {
    const Followed strong = follow(0.2, nullptr), weak = follow(0.01, nullptr);
    assert_true(weak.owner.folds.empty() && strong.owner.folds.size() == 2);
    Followed back = strong;
    std::reverse(back.owner.points.begin(), back.owner.points.end());
    const struct {
        const Followed *known;
        double ratio, force;
    } cases[] = {{&strong, 0.05, 0.01}, {&weak, 20, 0.2}, {&back, 1, 0.2}, {&strong, -3, 0.2}};
    for (const auto &c : cases) {
        plm::PathGuide guide = along(*c.known, c.ratio);
        const Followed alone = follow(c.force, nullptr), guided = follow(c.force, &guide);
        std::printf("    %lld failed steps, %zu points; alone %zu\n",
                    static_cast<long long>(guided.out.failed_steps), guided.owner.points.size(),
                    alone.owner.points.size());
        assert_true(same_ends_and_folds(guided, alone));
        assert_true(guided.out.failed_steps <= alone.out.failed_steps + 10);
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {cmocka_unit_test(the_same_path_by_fewer_steps),
                                cmocka_unit_test(a_neighbour_that_is_none_does_no_harm)};
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
