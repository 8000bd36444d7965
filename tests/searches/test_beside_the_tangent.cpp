// Folds and phase resonance as equations, over harmonic balance and over exact motions alike: derivatives.
#include "hbm/make_system.hpp"
#include "motions/fold_system.hpp"
#include "motions/phase_system.hpp"
#include "reduction/reduced_rest.hpp"
#include "searches/phase_resonance.hpp"
#include "searches/point_equations.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <random>

using plm::MotionsAre;

namespace {

constexpr double omega = 0.7;

std::shared_ptr<plm::ReducedModel> chain_model(double contact_stiffness = 30) {
    return test::reduce_exactly(
        exact::Structure(test::chain(6, 0.02, contact_stiffness, 0.05, 0.4, 0.3, {1, 3, 5})));
}

plm::HbmOptions chain_options() {
    plm::HbmOptions o;
    o.n_harmonics = 4;
    o.unknowns = plm::NonlinearUnknowns::modal;
    return o;
}

// A motion whose pairs open and close, no solution.
plm::BranchPoint moving_point(std::shared_ptr<const plm::ReducedModel> m) {
    const auto system = plm::make_system(m, chain_options());
    plm::vector<double> x(system->size());
    system->linear_response(plm::coupling_at_rest(*m), omega, x.data());
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    double size = 0;
    for (double v : x) size = std::max(size, std::abs(v));
    for (double &v : x) v += 0.3 * size * normal(random);
    plm::BranchPoint point;
    system->to_point(x.data(), omega, point);
    return point;
}

struct Errors {
    double solution = 0, parameter = 0;
};

// J^-1 (R(y + e d) - R(y - e d)) / 2e = d, and the same for dR/dp.
Errors derivative_errors(plm::Residual &system, const plm::vector<double> &y, double p, double step) {
    const std::int64_t n = system.size();
    plm::vector<double> up(n), down(n), r(n), d(n), shifted(y), by_p(n);
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    for (double &v : d) v = normal(random);
    const double size = *std::max_element(y.begin(), y.end());
    step *= size;
    for (std::int64_t i = 0; i < n; ++i) shifted[i] = y[i] + step * d[i];
    system.residual(shifted.data(), p, up.data());
    for (std::int64_t i = 0; i < n; ++i) shifted[i] = y[i] - step * d[i];
    system.residual(shifted.data(), p, down.data());
    system.residual(y.data(), p, r.data());
    system.linearize();
    system.parameter_derivative(by_p.data());
    for (std::int64_t i = 0; i < n; ++i) r[i] = (up[i] - down[i]) / (2 * step);
    system.solve(r.data(), 1);
    Errors e;
    for (std::int64_t i = 0; i < n; ++i) e.solution = std::max(e.solution, std::abs(r[i] - d[i]));
    system.residual(y.data(), p + step, up.data());
    system.residual(y.data(), p - step, down.data());
    double most = 0;
    for (double v : by_p) most = std::max(most, std::abs(v));
    for (std::int64_t i = 0; i < n; ++i)
        e.parameter = std::max(e.parameter, std::abs((up[i] - down[i]) / (2 * step) - by_p[i]) / most);
    return e;
}

template <class System, class... More> Errors errors_of(MotionsAre kind, double step, More... more) {
    const auto m = chain_model();
    const auto equations = plm::make_equations(m, chain_options(), kind, omega);
    System system(*equations, more...);
    return derivative_errors(system, system.unknowns(moving_point(m)), 0.9, step);
}

// What is told by differences of runs of the flow is right to some 1e-4.
void folds_match_differences(void **) {
    const plm::BranchPoint about = moving_point(chain_model());
    for (MotionsAre kind : {MotionsAre::harmonic, MotionsAre::exact}) {
        const Errors e = errors_of<plm::FoldSystem>(kind, 1e-6, about);
        assert_true(below(e.solution, kind == MotionsAre::exact ? 1e-3 : 1e-5));
        assert_true(below(e.parameter, kind == MotionsAre::exact ? 1e-3 : 1e-6));
    }
}

void phase_matches_differences(void **) {
    for (MotionsAre kind : {MotionsAre::harmonic, MotionsAre::exact}) {
        const Errors e = errors_of<plm::PhaseSystem>(kind, 1e-6, omega, 1.7);
        assert_true(below(e.solution, kind == MotionsAre::exact ? 1e-4 : 1e-5));
        assert_true(below(e.parameter, kind == MotionsAre::exact ? 1e-4 : 1e-6));
    }
}

// Followed over the stiffness, a resonance is that of the model that has it.
void peaks_are_followed_over_the_stiffness(void **) {
    plm::BackboneOptions options;
    options.hbm = chain_options();
    options.hbm.frequency_min_hz = 0.02;
    options.hbm.frequency_max_hz = 1;
    const plm::PhaseResonance resonance(chain_model(), options, plm::Watch());
    const auto backbones = resonance.backbones();
    assert_false(backbones.empty() || backbones[0].crossings.empty());
    plm::BranchPoint peak = backbones[0].branch->points()[backbones[0].crossings[0]];
    assert_true(resonance.correct(1, peak));
    const plm::StiffnessPath path = resonance.over_stiffness(peak, 4);
    const auto &points = path.branch->points();
    assert_true(points.size() == path.factor.size() && path.branch->end_reason == plm::reason::range_end);
    assert_true(near(path.factor.back(), 4, 1e-12));
    plm::BranchPoint other = points.back();
    assert_true(plm::PhaseResonance(chain_model(120), options, plm::Watch()).correct(1, other));
    assert_true(below(plm::solution_distance(points.back(), other), 1e-8)); // tolerance of the points
    assert_true(below(1e-3, plm::solution_distance(points.front(), points.back())));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(folds_match_differences),
        cmocka_unit_test(phase_matches_differences),
        cmocka_unit_test(peaks_are_followed_over_the_stiffness),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
