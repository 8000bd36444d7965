// Exact motions as periodic equations: how their derivatives change along a direction, against differences.
#include "orbits/exact_equations.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"

namespace {

constexpr double omega = 1.1;

plm::ExactEquations equations() {
    const auto m = test::reduce_exactly(test::chain(2, 0.05, 2, 0.1, 0.5, 0, {1}));
    return {m, plm::MotionOptions(), omega};
}

// -w . dR/domega and -w . dR/dforce at x + h v.
struct Seen {
    double by_frequency = 0, by_force = 0;
};
Seen seen(const plm::vector<double> &x, const plm::vector<double> &w, const plm::vector<double> &v,
          double h) {
    plm::ExactEquations e = equations();
    const std::int64_t n = e.size();
    plm::vector<double> at = x, r(x.size());
    for (std::int64_t i = 0; i < n; ++i) at[i] += h * v[i];
    e.residual(at.data(), omega, r.data());
    e.linearize();
    Seen s;
    e.parameter_derivative(r.data());
    s.by_frequency = -plm::dot(n, w.data(), r.data());
    e.derivative(plm::PathParameter::force, r.data());
    s.by_force = -plm::dot(n, w.data(), r.data());
    return s;
}

struct Changes {
    plm::MotionGradient got, of_twice;
    double by_frequency = 0, by_force = 0;
};
Changes changes() {
    plm::ExactEquations e = equations();
    const std::size_t n = static_cast<std::size_t>(e.size());
    plm::vector<double> x(n), w(n), v(n), twice(n), r(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double k = static_cast<double>(i);
        x[i] = 0.3 * std::cos(1.3 * k), w[i] = std::sin(1 + k), v[i] = std::cos(2 + 0.7 * k),
        twice[i] = 2 * v[i];
    }
    Changes c;
    for (const auto &[direction, gradient] : {std::pair(&v, &c.got), std::pair(&twice, &c.of_twice)}) {
        e.residual(x.data(), omega, r.data());
        e.linearize();
        *gradient = e.tangent_change(w, *direction);
    }
    constexpr double h = 1e-4;
    const Seen up = seen(x, w, v, h), down = seen(x, w, v, -h);
    c.by_frequency = (up.by_frequency - down.by_frequency) / (2 * h);
    c.by_force = (up.by_force - down.by_force) / (2 * h);
    return c;
}

// One-sided differences of a step of 1e-6 of the motion.
void the_change_of_the_tangent_is_its_derivative(void **) {
    const Changes c = changes();
    assert_true(std::abs(c.by_frequency) > 1e-3);
    assert_true(close_to(c.got.by_frequency, c.by_frequency, 1e-3));
    assert_true(near(c.got.by_force, c.by_force, 1e-3));
    assert_true(close_to(c.of_twice.by_frequency, 2 * c.got.by_frequency, 1e-3));
    double most = 0;
    for (double d : c.got.by_unknowns) most = std::max(most, std::abs(d));
    for (std::size_t i = 0; i < c.got.by_unknowns.size(); ++i)
        assert_true(near(c.of_twice.by_unknowns[i] / most, 2 * c.got.by_unknowns[i] / most, 1e-3));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_change_of_the_tangent_is_its_derivative),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
