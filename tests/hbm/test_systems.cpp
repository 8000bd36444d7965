// The two forms of the harmonic-balance equations: derivatives, agreement with each other, linear limits.
#include "hbm/start.hpp"
#include "hbm/system.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <random>

using plm::HbmOptions;
using plm::HbmSystem;
using plm::ReducedModel;
using plm::UnknownSpace;

namespace {

HbmOptions options_with(int harmonics, UnknownSpace unknowns) {
    HbmOptions o;
    o.n_harmonics = harmonics;
    o.unknowns = unknowns;
    return o;
}

std::unique_ptr<HbmSystem> system_of(std::shared_ptr<ReducedModel> m, int harmonics, UnknownSpace unknowns) {
    return plm::make_system(m, options_with(harmonics, unknowns));
}

exact::Structure chain_with(double preload, double gap) {
    return exact::Structure(test::chain(6, 0.02, 30, gap, 0.4, preload, {1, 3, 5}));
}

std::shared_ptr<ReducedModel> chain_model(double preload = 0.3, double gap = 0.05) {
    return test::reduce_exactly(chain_with(preload, gap));
}

plm::vector<double> random_point(HbmSystem &system, const ReducedModel &m, double omega) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    plm::vector<double> x(system.size());
    system.linear_response(plm::share_at_rest(m), omega, x.data());
    double size = 0;
    for (double v : x) size = std::max(size, std::abs(v));
    for (double &v : x) v += 0.3 * size * normal(random);
    return x;
}

struct DerivativeErrors {
    double x = 0, omega = 0;
};

// J^-1 (R(x + e d) - R(x - e d)) / 2e = d, and the same for omega by differences of R.
DerivativeErrors derivative_errors(std::shared_ptr<ReducedModel> m, UnknownSpace unknowns) {
    const auto system = system_of(m, 4, unknowns);
    const double omega = 0.7;
    const std::int64_t n = system->size();
    const plm::vector<double> x = random_point(*system, *m, omega);
    plm::vector<double> up(n), down(n), r(n), d(n);
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    for (double &v : d) v = normal(random);
    const double step = 1e-6;
    plm::vector<double> shifted(x);
    for (std::int64_t i = 0; i < n; ++i) shifted[i] = x[i] + step * d[i];
    system->residual(shifted.data(), omega, up.data());
    for (std::int64_t i = 0; i < n; ++i) shifted[i] = x[i] - step * d[i];
    system->residual(shifted.data(), omega, down.data());
    system->residual(x.data(), omega, r.data());
    system->linearize();
    for (std::int64_t i = 0; i < n; ++i) r[i] = (up[i] - down[i]) / (2 * step);
    system->solve(r.data(), 1);
    DerivativeErrors errors;
    for (std::int64_t i = 0; i < n; ++i) errors.x = std::max(errors.x, std::abs(r[i] - d[i]));
    system->residual(x.data(), omega + step, up.data());
    system->residual(x.data(), omega - step, down.data());
    system->residual(x.data(), omega, r.data());
    plm::vector<double> derivative(n);
    system->omega_derivative(derivative.data());
    double size = 0;
    for (std::int64_t i = 0; i < n; ++i) size = std::max(size, std::abs(derivative[i]));
    for (std::int64_t i = 0; i < n; ++i)
        errors.omega =
            std::max(errors.omega, std::abs((up[i] - down[i]) / (2 * step) - derivative[i]) / size);
    return errors;
}

std::shared_ptr<ReducedModel> with_full_damping() {
    exact::Structure s = chain_with(0.3, 0.05);
    for (int i = 0; i < s.n; ++i) s.damping[i * s.n + i] += 0.01 * (i + 1) * (i + 1);
    return test::reduce_exactly(s);
}

std::shared_ptr<ReducedModel> with_structural_damping() {
    auto m = chain_model();
    m->structural = 0.03;
    return m;
}

// Different bases for h = 0 and h >= 1: three modes for the motion, all for the mean.
std::shared_ptr<ReducedModel> with_static_basis() {
    auto m = chain_model();
    m->same_static = false;
    m->vectors_0 = m->vectors;
    m->vectors = m->vectors.columns(0, 3);
    m->gap = m->gap.columns(0, 3);
    m->lambda.resize(3);
    m->damping_diagonal.resize(3);
    m->excitation[1].real.resize(3);
    m->excitation[1].imag.resize(3);
    return m;
}

void check_derivatives(std::shared_ptr<ReducedModel> m) {
    for (UnknownSpace unknowns : {UnknownSpace::modal, UnknownSpace::gaps}) {
        const DerivativeErrors e = derivative_errors(m, unknowns);
        assert_true(below(e.x, 1e-6)); // differences: rounding / step
        assert_true(below(e.omega, 1e-7));
    }
}
void jacobians_match_differences(void **) {
    check_derivatives(chain_model());
}
void jacobians_match_with_full_damping(void **) {
    check_derivatives(with_full_damping());
}
void jacobians_match_with_structural_damping(void **) {
    check_derivatives(with_structural_damping());
}
void jacobians_match_with_a_static_basis(void **) {
    check_derivatives(with_static_basis());
}

// A free-floating chain held only by its contacts.
std::shared_ptr<ReducedModel> rigid_when_open() {
    exact::Structure s = test::chain(4, 0.02, 5, 0, 0.4, 0.5, {3});
    s.stiffness[0] = 1; // no spring to the left wall any more
    for (std::size_t i = 0; i < s.damping.size(); ++i) s.damping[i] = 0.05 * s.stiffness[i];
    auto m = test::reduce_exactly(s);
    m->lambda[0] = m->lambda_0[0] = 0;
    return m;
}
void jacobians_match_with_rigid_body_modes(void **) {
    check_derivatives(rigid_when_open());
}

struct Solved {
    bool converged = false;
    plm::BranchPoint point;
};
Solved solve(std::shared_ptr<ReducedModel> m, UnknownSpace unknowns, double omega, int harmonics = 7) {
    const auto system = system_of(m, harmonics, unknowns);
    const HbmOptions o = options_with(harmonics, unknowns);
    plm::vector<double> x(system->size());
    Solved s;
    s.converged = plm::find_start(*system, *m, o, omega, false, plm::Watch(), x).converged;
    system->to_point(x.data(), omega, s.point);
    return s;
}

double difference(const Solved &a, const Solved &b) {
    double size = 0, off = 0;
    for (std::size_t j = 0; j < a.point.eta_0.size(); ++j) {
        size = std::max(size, std::abs(a.point.eta_0[j]));
        off = std::max(off, std::abs(a.point.eta_0[j] - b.point.eta_0[j]));
    }
    for (std::int64_t k = 0; k < a.point.eta.rows() * a.point.eta.cols(); ++k) {
        size = std::max(size, std::abs(a.point.eta.data()[k]));
        off = std::max(off, std::abs(a.point.eta.data()[k] - b.point.eta.data()[k]));
    }
    return a.converged && b.converged ? off / size : 1e300;
}

double worst_difference(std::shared_ptr<ReducedModel> m) {
    double worst = 0;
    for (double omega : {0.15, 0.4, 0.9, 1.3})
        worst = std::max(
            worst, difference(solve(m, UnknownSpace::modal, omega), solve(m, UnknownSpace::gaps, omega)));
    return worst;
}
void both_forms_have_the_same_solution(void **) {
    assert_true(below(worst_difference(chain_model()), 1e-8)); // Newton tolerance 1e-9 on each
    assert_true(below(worst_difference(with_full_damping()), 1e-8));
    assert_true(below(worst_difference(with_structural_damping()), 1e-8));
    assert_true(below(worst_difference(with_static_basis()), 1e-8));
    assert_true(below(worst_difference(rigid_when_open()), 1e-8));
}

// Always open: the linear structure. Always closed: the linear structure with the springs in.
double linear_error(bool closed, UnknownSpace unknowns) {
    exact::Structure s = chain_with(closed ? 50.0 : 0.0, closed ? 0.0 : 1e3);
    s.gap_rows.assign(s.gap_rows.size(), 0.0);
    for (int p = 0; p < s.z; ++p)
        s.gap_rows[p * s.n + 2 * p + 1] = 1; // against the ground, all pressed by the load
    const double omega = 0.8;
    const Solved got = solve(test::reduce_exactly(s), unknowns, omega, 3);
    exact::Structure linear = s;
    for (int p = 0; p < s.z && closed; ++p)
        linear.stiffness[(2 * p + 1) * s.n + 2 * p + 1] += s.contact_stiffness[p];
    const auto m = test::reduce_exactly(linear);
    m->contact_stiffness.clear(), m->initial_gap.clear();
    m->gap = m->gap_0 = plm::Matrix(0, m->size());
    const Solved want = solve(m, UnknownSpace::modal, omega, 3);
    const auto original = test::reduce_exactly(s);
    double worst = 0, size = 0;
    for (int dof = 0; dof < s.n; ++dof) {
        const auto a = test::displacement(*original, got.point.eta_0, got.point.eta, dof);
        const auto b = test::displacement(*m, want.point.eta_0, want.point.eta, dof);
        for (std::size_t c = 0; c < a.size(); ++c) {
            worst = std::max(worst, std::abs(a[c] - b[c]));
            if (c > 0) size = std::max(size, std::abs(b[c]));
        }
    }
    return got.converged && want.converged ? worst / size : 1e300;
}
void open_and_closed_contact_are_linear(void **) {
    for (UnknownSpace unknowns : {UnknownSpace::modal, UnknownSpace::gaps}) {
        assert_true(below(linear_error(false, unknowns), 1e-12));
        assert_true(
            below(linear_error(true, unknowns), 1e-10)); // the static part, 100 times larger, limits the rest
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(jacobians_match_differences),
        cmocka_unit_test(jacobians_match_with_full_damping),
        cmocka_unit_test(jacobians_match_with_structural_damping),
        cmocka_unit_test(jacobians_match_with_a_static_basis),
        cmocka_unit_test(jacobians_match_with_rigid_body_modes),
        cmocka_unit_test(both_forms_have_the_same_solution),
        cmocka_unit_test(open_and_closed_contact_are_linear),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
