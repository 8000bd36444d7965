// The two forms of the harmonic-balance equations: derivatives, agreement with each other, linear limits.
#include "hbm/harmonic_equations.hpp"
#include "hbm/make_system.hpp"
#include "hbm/modal_factor.hpp"
#include "hbm/mode_system.hpp"
#include "hbm/options.hpp"
#include "hbm/start.hpp"
#include "hbm/system.hpp"
#include "linalg/support.hpp"
#include "motions/phase_system.hpp"
#include "reduction/reduced_rest.hpp"
#include "support/small_reduced.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <random>

using plm::HbmOptions;
using plm::HbmSystem;
using plm::NonlinearUnknowns;
using plm::ReducedModel;

namespace {

HbmOptions options_with(int harmonics, NonlinearUnknowns unknowns) {
    HbmOptions o;
    o.n_harmonics = harmonics;
    o.unknowns = unknowns;
    return o;
}

std::unique_ptr<HbmSystem> system_of(std::shared_ptr<ReducedModel> m, int harmonics,
                                     NonlinearUnknowns unknowns) {
    return plm::make_system(m, options_with(harmonics, unknowns));
}

exact::Structure chain_with(double preload, double gap) {
    return exact::Structure(test::chain(6, 0.02, 30, gap, 0.4, preload, {1, 3, 5}));
}

std::shared_ptr<ReducedModel> chain_model(double preload = 0.3, double gap = 0.05) {
    return test::reduce_exactly(chain_with(preload, gap));
}

plm::vector<double> random_point(HbmSystem &system, const ReducedModel &m, double omega) {
    test::Random random(1);
    plm::vector<double> x(system.size());
    system.linear_response(plm::coupling_at_rest(m), omega, x.data());
    double size = 0;
    for (double v : x) size = std::max(size, std::abs(v));
    for (double &v : x) v += 0.5 * size * random();
    return x;
}

struct DerivativeErrors {
    double x = 0, omega = 0;
};

// J^-1 (R(x + e d) - R(x - e d)) / 2e = d
double solution_error(plm::Residual &system, const plm::vector<double> &x, double omega, double step = 1e-6) {
    const std::int64_t n = system.size();
    plm::vector<double> up(n), down(n), r(n), d(n);
    test::Random random(2);
    for (double &v : d) v = random();
    plm::vector<double> shifted(x);
    for (std::int64_t i = 0; i < n; ++i) shifted[i] = x[i] + step * d[i];
    system.residual(shifted.data(), omega, up.data());
    for (std::int64_t i = 0; i < n; ++i) shifted[i] = x[i] - step * d[i];
    system.residual(shifted.data(), omega, down.data());
    system.residual(x.data(), omega, r.data());
    system.linearize();
    for (std::int64_t i = 0; i < n; ++i) r[i] = (up[i] - down[i]) / (2 * step);
    system.solve(r.data(), 1);
    double worst = 0;
    for (std::int64_t i = 0; i < n; ++i) worst = std::max(worst, std::abs(r[i] - d[i]));
    return worst;
}

double parameter_derivative_error(plm::Residual &system, const plm::vector<double> &x, double omega) {
    const std::int64_t n = system.size();
    plm::vector<double> up(n), down(n), r(n), derivative(n);
    const double step = 1e-6;
    system.residual(x.data(), omega + step, up.data());
    system.residual(x.data(), omega - step, down.data());
    system.residual(x.data(), omega, r.data());
    system.linearize();
    system.parameter_derivative(derivative.data());
    double size = 0, worst = 0;
    for (std::int64_t i = 0; i < n; ++i) size = std::max(size, std::abs(derivative[i]));
    for (std::int64_t i = 0; i < n; ++i)
        worst = std::max(worst, std::abs((up[i] - down[i]) / (2 * step) - derivative[i]) / size);
    return worst;
}

DerivativeErrors derivative_errors(std::shared_ptr<ReducedModel> m, NonlinearUnknowns unknowns,
                                   double self_excitation = 0) {
    const auto system = system_of(m, 4, unknowns);
    if (self_excitation != 0) system->set_self_excitation(self_excitation);
    const double omega = 0.7;
    const plm::vector<double> x = random_point(*system, *m, omega);
    return {solution_error(*system, x, omega), parameter_derivative_error(*system, x, omega)};
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
    m->vectors = plm::SpaceVectors(m->vectors_0.formed().columns(0, 3));
    m->to_static = plm::Matrix(m->static_size(), 3);
    for (int j = 0; j < 3; ++j) m->to_static(j, j) = 1;
    m->gap = m->gap.columns(0, 3);
    m->lambda.resize(3);
    m->damping_diagonal.resize(3);
    m->excitation[1].real.resize(3);
    m->excitation[1].imag.resize(3);
    return m;
}

void check_derivatives(std::shared_ptr<ReducedModel> m) {
    for (NonlinearUnknowns unknowns : {NonlinearUnknowns::modal, NonlinearUnknowns::gaps}) {
        const DerivativeErrors e = derivative_errors(m, unknowns);
        assert_true(below(e.x, 1e-6)); // differences: rounding / step
        assert_true(below(e.omega, 1e-7));
    }
}
void jacobians_match_differences(void **) {
    check_derivatives(chain_model());
}
std::shared_ptr<ReducedModel> with_a_massless_coordinate() {
    auto m = chain_model();
    m->n_massless = m->n_massless_0 = 1;
    return m;
}
void jacobians_match_without_mass(void **) {
    check_derivatives(with_a_massless_coordinate());
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

// One in the harmonic of the force, one in another, and a mean; of which velocity and acceleration are given.
std::shared_ptr<ReducedModel> with_moving_walls(std::shared_ptr<ReducedModel> m) {
    m->contact.motion = {{0, {{0.01}, {}}},
                         {1, {{0.04, -0.03}, {0.02, 0.05}}},
                         {3, {{0, 0.01}, {0.015}}},
                         {{1, -1}, {{0.01, 0.02}, {-0.02, 0.01}}},
                         {{2, -2}, {{0.015, 0}, {0.01, 0.005}}}};
    return m;
}
void jacobians_match_with_moving_walls(void **) {
    check_derivatives(with_moving_walls(chain_model()));
    check_derivatives(with_moving_walls(with_static_basis()));
}

// Of every power, and a mean; beside a force that does not.
std::shared_ptr<ReducedModel> with_growing_loads(std::shared_ptr<ReducedModel> m) {
    const plm::HarmonicLoad force = m->excitation.at(1);
    for (int power : {-1, 1, 2}) {
        plm::HarmonicLoad &part = m->excitation[{1, power}];
        part = force;
        for (double &f : part.imag) f += 0.05 * power;
    }
    m->excitation[{3, 2}] = force;
    m->excitation[{0, 2}].real.assign(static_cast<std::size_t>(m->static_size()), 0.03);
    return m;
}
void jacobians_match_with_loads_that_grow(void **) {
    for (const auto &m :
         {chain_model(), with_full_damping(), with_static_basis(), with_a_massless_coordinate()})
        check_derivatives(with_growing_loads(m));
}
// What the wrong sign, or the wrong power, would show in both forms alike: the load of one frequency.
void loads_are_those_of_their_frequency(void **) {
    constexpr double omega = 0.7;
    for (NonlinearUnknowns unknowns : {NonlinearUnknowns::modal, NonlinearUnknowns::gaps})
        for (std::int64_t multiple : {1, 2}) {
            const auto growing = with_moving_walls(with_growing_loads(chain_model())), still = chain_model();
            still->excitation.clear();
            for (const auto &[part, gaps] : growing->contact.motion) {
                plm::GapHarmonic &sum = still->contact.motion[part.harmonic];
                for (const auto &[from, to] :
                     {std::pair(&gaps.real, &sum.real), std::pair(&gaps.imag, &sum.imag)}) {
                    to->resize(std::max(to->size(), from->size()), 0.0);
                    for (std::size_t i = 0; i < from->size(); ++i)
                        (*to)[i] += std::pow(omega, part.power) * (*from)[i];
                }
            }
            for (const auto &[part, load] : growing->excitation) {
                plm::HarmonicLoad &sum = still->excitation[part.harmonic];
                sum.real.resize(load.real.size(), 0.0), sum.imag.resize(load.imag.size(), 0.0);
                for (std::size_t j = 0; j < load.real.size(); ++j)
                    sum.real[j] += std::pow(omega, part.power) * load.real[j];
                for (std::size_t j = 0; j < load.imag.size(); ++j)
                    sum.imag[j] += std::pow(omega, part.power) * load.imag[j];
            }
            HbmOptions o = options_with(4, unknowns);
            o.period_multiple = multiple;
            o.force_scale = 1.3;
            const auto one = plm::make_system(growing, o), other = plm::make_system(still, o);
            const plm::vector<double> x = random_point(*one, *growing, omega);
            plm::vector<double> a(x.size()), b(x.size());
            one->residual(x.data(), omega, a.data());
            other->residual(x.data(), omega, b.data());
            for (std::size_t i = 0; i < x.size(); ++i) assert_true(below(std::abs(a[i] - b[i]), 1e-12));
        }
}

// Of the residual, by the scale that forces and walls have in common.
double force_derivative_error(HbmSystem &system, const plm::vector<double> &x) {
    constexpr double omega = 0.7, scale = 1.2, step = 1e-6;
    const std::int64_t n = system.size();
    plm::vector<double> up(n), down(n), r(n), derivative(n);
    system.set_force_scale(scale + step);
    system.residual(x.data(), omega, up.data());
    system.set_force_scale(scale - step);
    system.residual(x.data(), omega, down.data());
    system.set_force_scale(scale);
    system.residual(x.data(), omega, r.data());
    system.force_derivative(derivative.data());
    double size = 0, worst = 0;
    for (std::int64_t i = 0; i < n; ++i) {
        size = std::max(size, std::abs(derivative[i]));
        worst = std::max(worst, std::abs((up[i] - down[i]) / (2 * step) - derivative[i]));
    }
    return worst / size;
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

void walls_move_with_the_scale_of_the_force(void **) {
    for (const auto &m : {chain_model(), with_static_basis(), rigid_when_open()})
        for (NonlinearUnknowns unknowns : {NonlinearUnknowns::modal, NonlinearUnknowns::gaps})
            for (std::int64_t multiple : {1, 2}) {
                HbmOptions o = options_with(4, unknowns);
                o.period_multiple = multiple;
                const auto moving = with_moving_walls(m);
                const auto system = plm::make_system(moving, o);
                assert_true(
                    below(force_derivative_error(*system, random_point(*system, *moving, 0.7)), 1e-6));
            }
}

void jacobians_match_with_self_excitation(void **) {
    for (const auto &m : {chain_model(), with_full_damping(), with_structural_damping()}) {
        const DerivativeErrors e = derivative_errors(m, NonlinearUnknowns::modal, 0.07);
        assert_true(below(e.x, 1e-6));
        assert_true(below(e.omega, 1e-7));
    }
}

// With more equations: phase resonance (parameter: the force), nonlinear modes (parameter: log amplitude).
void jacobians_with_more_equations_match_differences(void **) {
    for (const auto &m :
         {chain_model(), with_full_damping(), with_static_basis(), with_a_massless_coordinate()}) {
        const auto inner = system_of(m, 4, NonlinearUnknowns::modal);
        plm::vector<double> x = random_point(*inner, *m, 0.7);
        x.push_back(0.1);
        plm::HarmonicEquations equations(m, options_with(4, NonlinearUnknowns::modal), 0.65);
        plm::PhaseSystem resonance(equations, 0.65, 1.7);
        // a pair nearly grazes here: the difference quotient needs a small step
        assert_true(below(solution_error(resonance, x, 0.9, 1e-7), 1e-5));
        assert_true(below(parameter_derivative_error(resonance, x, 0.9), 1e-7));
        x.push_back(0.03);
        plm::vector<double> shape(m->size(), 0.3);
        plm::NonlinearModeSystem mode(*inner, *m, shape, 0.65, 2.5);
        assert_true(below(solution_error(mode, x, 0.2, 1e-7), 1e-5));
    }
}

// --- factorizations through the contact forces (ModalFactor) against those of the whole matrix

enum class Damping { none, diagonal, full, structural };

plm::Matrix random_matrix(std::int64_t rows, std::int64_t cols, std::mt19937 &random) {
    std::normal_distribution<double> normal;
    plm::Matrix a(rows, cols);
    for (std::int64_t k = 0; k < rows * cols; ++k) a.data()[k] = normal(random);
    return a;
}

// 3 pairs on 8 coordinates; 10 others for the mean when `separate`, of which one may be unstable.
std::shared_ptr<ReducedModel> random_model(Damping damping, bool separate, std::mt19937 &random) {
    const std::int64_t r = 8, z = 3, r0 = separate ? 10 : r;
    auto m = std::make_shared<ReducedModel>();
    std::uniform_real_distribution<double> between(0.5, 1.5);
    for (std::int64_t j = 0; j < r; ++j) m->lambda.push_back(std::pow(j + between(random), 2));
    m->gap = random_matrix(z, r, random);
    m->contact = {plm::vector<double>(z, 1.0), plm::vector<double>(z, 0.0), {}};
    m->damping_diagonal.assign(r, damping == Damping::diagonal ? 0.1 : 0.0);
    if (damping == Damping::structural) m->structural = 0.05;
    if (damping == Damping::full) {
        const plm::Matrix a = random_matrix(r, r, random);
        m->damping = plm::product('T', 'N', a, a);
        for (std::int64_t k = 0; k < r * r; ++k) m->damping.data()[k] *= 0.05;
        m->damping_diagonal.clear();
    }
    m->same_static = !separate;
    m->lambda_0 = m->lambda;
    m->gap_0 = m->gap;
    if (separate) {
        m->lambda_0.assign(r0, 2.0);
        m->lambda_0[4] = -1;
        m->gap_0 = random_matrix(z, r0, random);
    }
    return m;
}

// One pair that moves, one that stays closed, one that stays open.
plm::ModalJacobian random_jacobian(std::shared_ptr<ReducedModel> m, double omega, std::mt19937 &random) {
    const std::int64_t h = 3;
    plm::ContactIndicator s;
    s.averages = random_matrix(4 * h + 1, 3, random);
    for (std::int64_t k = 0; k <= 4 * h; ++k) {
        s.averages(k, 1) = k == 0;
        s.averages(k, 2) = 0;
    }
    s.state = {plm::PairState::switching, plm::PairState::closed, plm::PairState::open};
    plm::ModalJacobian jacobian(m, h);
    jacobian.set_omega(omega);
    jacobian.set_self_excitation(0.01);
    jacobian.set_tangent(s, {20.0, 30.0, 40.0});
    jacobian.expand_tangent();
    return jacobian;
}

plm::Border random_border(std::int64_t n, std::int64_t k, std::mt19937 &random) {
    plm::Border border;
    border.columns = random_matrix(n, k, random);
    border.rows = random_matrix(n, k, random);
    border.corner = random_matrix(k, k, random);
    return border;
}

double relative_difference(const plm::Matrix &a, const plm::Matrix &b) {
    double off = 0, size = 0;
    for (std::int64_t k = 0; k < a.rows() * a.cols(); ++k) {
        off = std::max(off, std::abs(a.data()[k] - b.data()[k]));
        size = std::max(size, std::abs(b.data()[k]));
    }
    return off / size;
}

// Whether a column has the same bits in both: of two ways to factor a matrix each leaves its own rounding.
bool identical(const plm::Matrix &a, const plm::Matrix &b, std::int64_t column) {
    return std::equal(a.col(column), a.col(column) + a.rows(), b.col(column));
}

struct Comparison {
    bool condensed = true; // every solution is another one than the dense, but for its last digits
    bool same_signs = true;
    int n_negative = 0, n = 0;
    double worst = 0; // of the solutions
};

void compare(plm::ModalJacobian &jacobian, const plm::Border &border, std::mt19937 &random, Comparison &all) {
    plm::ModalFactor condensed, dense;
    condensed.factor(jacobian, border);
    dense.factor(jacobian, border, false);
    all.same_signs = all.same_signs && condensed.determinant_sign() == dense.determinant_sign();
    all.n_negative += dense.determinant_sign() < 0;
    ++all.n;
    const plm::Matrix b = random_matrix(dense.size(), 2, random);
    plm::Matrix x = b, y = b;
    condensed.solve(x.data(), 2);
    dense.solve(y.data(), 2);
    all.worst = std::max(all.worst, relative_difference(x, y));
    for (std::int64_t c : {0, 1}) all.condensed = all.condensed && !identical(x, y, c);
    x = y = b;
    condensed.solve_transposed(x.data(), 2);
    dense.solve_transposed(y.data(), 2);
    all.worst = std::max(all.worst, relative_difference(x, y));
    for (std::int64_t c : {0, 1}) all.condensed = all.condensed && !identical(x, y, c);
}

Comparison compare_random(Damping damping, bool separate, std::int64_t n_borders) {
    std::mt19937 random(7);
    Comparison all;
    for (int k = 0; k < 20; ++k) {
        plm::ModalJacobian jacobian = random_jacobian(random_model(damping, separate, random), 0.83, random);
        compare(jacobian, random_border(jacobian.size(), n_borders, random), random, all);
    }
    return all;
}

void condensed_factors_solve_like_dense_ones(void **) {
    for (Damping damping : {Damping::none, Damping::diagonal, Damping::full, Damping::structural})
        for (bool separate : {false, true})
            for (std::int64_t n_borders : {0, 1, 2}) {
                const Comparison all = compare_random(damping, separate, n_borders);
                assert_true(all.condensed);
                assert_true(all.same_signs);
                assert_true(all.n_negative > 0 && all.n_negative < all.n);
                assert_true(below(all.worst, 1e-10));
            }
}

// The matrix itself, column by column, from the products the solutions are refined with.
double product_error(Damping damping, bool separate, bool transposed) {
    std::mt19937 random(9);
    plm::ModalJacobian jacobian = random_jacobian(random_model(damping, separate, random), 0.83, random);
    const std::int64_t n = jacobian.size();
    plm::Matrix dense(n, n), columns(n, n);
    jacobian.write_to(dense);
    for (std::int64_t j = 0; j < n; ++j) {
        plm::vector<double> e(n, 0.0);
        e[j] = 1;
        jacobian.product(transposed, e.data(), columns.col(j));
    }
    return relative_difference(columns, transposed ? dense.transposed() : dense);
}
void products_agree_with_the_dense_matrix(void **) {
    for (Damping damping : {Damping::diagonal, Damping::full, Damping::structural})
        for (bool separate : {false, true})
            for (bool transposed : {false, true})
                assert_true(below(product_error(damping, separate, transposed), 1e-14));
}

// Closer and closer to a resonance of the undamped open structure, where D is singular but J is not.
void condensed_factors_serve_near_open_resonances(void **) {
    std::mt19937 random(3);
    const auto m = random_model(Damping::none, false, random);
    for (double distance : {1e-3, 1e-6, 1e-8, 1e-9, 1e-12, 0.0}) {
        plm::ModalJacobian jacobian =
            random_jacobian(m, std::sqrt(m->lambda[2]) / 2 * (1 + distance), random);
        jacobian.set_self_excitation(0);
        for (std::int64_t n_borders : {0, 1}) {
            Comparison all;
            compare(jacobian, random_border(jacobian.size(), n_borders, random), random, all);
            assert_true(all.same_signs);
            assert_true(below(all.worst, 1e-10));
        }
    }
}

// Stiff contact on a structure that is nearly singular without it: condensed, with as good a linear part as
// under soft contact, but its solutions are given up, and the whole matrix answers to the last bit.
struct Repeated {
    int n_alike = 0; // of three solutions: the same bits as those of the whole matrix
    double worst = 0;
};
Repeated solve_by_soft_structure(double gap) {
    std::mt19937 random(3);
    const auto m = random_model(Damping::diagonal, true, random);
    m->lambda_0[0] = 1e-8;
    m->gap_0(0, 0) = gap;
    plm::ModalJacobian jacobian = random_jacobian(m, 0.83, random);
    const plm::Border border = random_border(jacobian.size(), 1, random);
    plm::ModalFactor factor, dense;
    factor.factor(jacobian, border);
    dense.factor(jacobian, border, false);
    const plm::Matrix b = random_matrix(dense.size(), 3, random);
    plm::Matrix x = b, y = b;
    factor.solve(x.data(), 3);
    dense.solve(y.data(), 3);
    Repeated r;
    for (std::int64_t c : {0, 1, 2}) r.n_alike += identical(x, y, c);
    r.worst = relative_difference(x, y);
    return r;
}
void hopeless_condensed_solutions_are_repeated_with_the_whole_matrix(void **) {
    const Repeated soft = solve_by_soft_structure(1), stiff = solve_by_soft_structure(3e6);
    assert_int_equal(soft.n_alike, 0); // condensed
    assert_true(below(soft.worst, 1e-10));
    assert_int_equal(stiff.n_alike, 3);
}

// As its whole matrix, to the last bit.
bool is_solved_whole(plm::ModalJacobian jacobian, std::mt19937 &random) {
    plm::ModalFactor factor, dense;
    factor.factor(jacobian, plm::Border());
    dense.factor(jacobian, plm::Border(), false);
    plm::Matrix x = random_matrix(dense.size(), 1, random), y = x;
    factor.solve(x.data(), 1);
    dense.solve(y.data(), 1);
    return identical(x, y, 0);
}
void singular_or_large_condensations_are_not_used(void **) {
    std::mt19937 random(5);
    const auto rigid = random_model(Damping::diagonal, false, random);
    assert_false(is_solved_whole(random_jacobian(rigid, 0.83, random), random));
    rigid->lambda_0[0] = 0;
    assert_true(is_solved_whole(random_jacobian(rigid, 0.83, random), random));
    const auto small = random_model(Damping::diagonal, false, random);
    small->lambda.resize(2), small->lambda_0.resize(2), small->damping_diagonal.resize(2);
    small->gap = small->gap_0 = small->gap.columns(0, 2);
    assert_true(is_solved_whole(random_jacobian(small, 0.83, random), random));
}

struct Solved {
    bool converged = false;
    plm::BranchPoint point;
};
Solved solve(std::shared_ptr<ReducedModel> m, NonlinearUnknowns unknowns, double omega, int harmonics = 7) {
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
        worst = std::max(worst, difference(solve(m, NonlinearUnknowns::modal, omega),
                                           solve(m, NonlinearUnknowns::gaps, omega)));
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
double linear_error(bool closed, NonlinearUnknowns unknowns) {
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
    m->contact.stiffness.clear(), m->contact.initial_gap.clear();
    m->gap = m->gap_0 = plm::Matrix(0, m->size());
    const Solved want = solve(m, NonlinearUnknowns::modal, omega, 3);
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
    for (NonlinearUnknowns unknowns : {NonlinearUnknowns::modal, NonlinearUnknowns::gaps}) {
        assert_true(below(linear_error(false, unknowns), 1e-12));
        assert_true(
            below(linear_error(true, unknowns), 1e-10)); // the static part, 100 times larger, limits the rest
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(jacobians_match_differences),
        cmocka_unit_test(jacobians_match_without_mass),
        cmocka_unit_test(jacobians_match_with_full_damping),
        cmocka_unit_test(jacobians_match_with_structural_damping),
        cmocka_unit_test(jacobians_match_with_a_static_basis),
        cmocka_unit_test(jacobians_match_with_rigid_body_modes),
        cmocka_unit_test(jacobians_match_with_moving_walls),
        cmocka_unit_test(jacobians_match_with_loads_that_grow),
        cmocka_unit_test(loads_are_those_of_their_frequency),
        cmocka_unit_test(walls_move_with_the_scale_of_the_force),
        cmocka_unit_test(jacobians_match_with_self_excitation),
        cmocka_unit_test(jacobians_with_more_equations_match_differences),
        cmocka_unit_test(condensed_factors_solve_like_dense_ones),
        cmocka_unit_test(products_agree_with_the_dense_matrix),
        cmocka_unit_test(condensed_factors_serve_near_open_resonances),
        cmocka_unit_test(hopeless_condensed_solutions_are_repeated_with_the_whole_matrix),
        cmocka_unit_test(singular_or_large_condensations_are_not_used),
        cmocka_unit_test(both_forms_have_the_same_solution),
        cmocka_unit_test(open_and_closed_contact_are_linear),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
