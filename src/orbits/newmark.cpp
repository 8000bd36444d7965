#include "orbits/newmark.hpp"
#include "linalg/scale.hpp"
#include "orbits/settling.hpp"
#include "space/spaceless.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double massless_share = 1e-3; // of a step: how long mass-less DOFs take to their first equilibrium

void refuse(const char *name, const std::string &text) {
    throw Error(status::argument, text).argument(name);
}

std::shared_ptr<const Model> checked(std::shared_ptr<const Model> given, double omega) {
    const Model &model = *given;
    if (!(omega > 0 && std::isfinite(omega))) refuse("omega", "the frequency must be positive and finite");
    for (double ratio : model.damping().modal_ratio)
        if (ratio != 0)
            refuse("modal_ratio",
                   "time integration of the full model takes Rayleigh damping, an explicit C or "
                   "structural damping; modal damping has no sparse form");
    return given;
}

bool fits(const Field &x, const Model &model) {
    return x.rows() == model.n_free() && x.cols() == 1 && std::isfinite(column_norms(x)[0]);
}

// The mass matrix, or where DOFs have no mass, with so much stiffness that they follow within `time`.
Combination mass_factor(const Model &model, double time) {
    Combination mass(model, {1, 0, 0});
    if (model.n_massless_dofs() == 0) {
        try {
            mass.factor();
            return mass;
        } catch (const Error &e) { // singular all the same
            if (e.status() != status::not_positive_definite) throw;
        }
    }
    Combination stiffened(model, {1, time * time, 0});
    stiffened.factor();
    return stiffened;
}

MatrixWeights damping_of(const Model &model, double omega) {
    const Damping &d = model.damping();
    return {d.alpha, d.beta + d.structural / omega, d.has_matrix ? 1.0 : 0.0};
}

// S = M / (beta dt^2) + (1 - alpha) (gamma / (beta dt) C + K).
MatrixWeights step_of(const Model &model, double omega, const NewmarkOptions &o) {
    const NewmarkRule r(o, omega);
    const MatrixWeights c = damping_of(model, omega);
    const double by_damping = r.now * r.gamma / (r.beta * r.dt);
    return {1 / (r.beta * r.dt * r.dt) + by_damping * c.mass, r.now + by_damping * c.stiffness,
            by_damping * c.damping};
}

} // namespace

NewmarkRule::NewmarkRule(const NewmarkOptions &o, double omega)
    : dt(2 * M_PI / omega / static_cast<double>(o.steps_per_period)),
      beta(0.25 * (1 + o.alpha) * (1 + o.alpha)), gamma(0.5 + o.alpha), now(1 - o.alpha) {}

Newmark::Newmark(std::shared_ptr<const Model> model, double omega, const NewmarkOptions &options, Watch watch)
    : model_(checked(std::move(model), omega)), omega_(omega), rule_(options, omega), options_(options),
      watch_(watch), damping_(*model_, damping_of(*model_, omega)),
      step_(*model_, step_of(*model_, omega, options)) {
    watch_.step("time integration", 0.0);
    step_.factor();
    find_flexibility();
}

// Of S at the contact.
void Newmark::find_flexibility() {
    response_ = model_->gap_rows().columns();
    Matrix flexibility;
    if (model_->n_pairs() > 0) {
        step_.solve(response_);
        flexibility = model_->gap_rows().of(response_);
        for (std::int64_t j = 0; j < flexibility.cols(); ++j)
            for (std::int64_t i = 0; i <= j; ++i)
                flexibility(i, j) = flexibility(j, i) =
                    0.5 * rule_.now * (flexibility(i, j) + flexibility(j, i));
    }
    contact_ = std::make_unique<ContactStep>(std::move(flexibility), model_->contact_stiffness());
}

FullState rest_state(const std::shared_ptr<const Model> &model, Watch watch) {
    FullState state{model->zeros(1), model->zeros(1), 0};
    if (model->has_preload() || model->contact().has_interference())
        state.q = rest_of(model, watch)->displacement;
    return state;
}

// Pre-load and w^p Re(F_h exp(i h w t)).
void Newmark::excitation(double time, Field &f) const {
    f.clear();
    if (model_->has_preload()) add(1.0, model_->preload(), f);
    for (const auto &[part, load] : model_->excitation()) {
        const double phase = part.harmonic * omega_ * time,
                     scale = options_.force_scale * part.growth(omega_);
        add(scale * std::cos(phase), load.real, f);
        if (part.harmonic > 0) add(-scale * std::sin(phase), load.imag, f);
    }
}

// f -= K q + C v.
void Newmark::subtract_internal_forces(const Field &q, const Field &v, Field &f) {
    model_->stiffness_times(q, work_);
    add(-1.0, work_, f);
    if (damping_.is_zero()) return;
    damping_.apply(v, work_);
    add(-1.0, work_, f);
}

void Newmark::subtract_gaps(double time) {
    const vector<double> gaps = model_->contact().gaps_at(omega_, time, options_.force_scale);
    for (std::size_t i = 0; i < u_free_.size(); ++i) u_free_[i] -= gaps[i];
}

// Forces and acceleration that go with the first state.
void Newmark::start(const FullState &state) {
    const std::int64_t n = model_->n_free(), z = model_->n_pairs();
    if (!fits(state.q, *model_) || !fits(state.v, *model_) || !std::isfinite(state.time))
        refuse("start", format("the first state needs %lld finite displacements and velocities (free DOFs)",
                               static_cast<long long>(n)));
    state_ = state;
    for (Field *x : {&a_, &rest_force_, &q_, &v_, &load_, &work_}) *x = model_->zeros(1);
    contact_force_.assign(z, 0.0);
    const Matrix u = model_->gap_rows().of(state_.q);
    u_free_.assign(u.data(), u.data() + z);
    Matrix force(z, 1);
    subtract_gaps(state_.time);
    for (std::int64_t i = 0; i < z; ++i)
        force(i, 0) = contact_force_[i] = model_->contact().force(i, u_free_[i]);
    excitation(state_.time, rest_force_);
    subtract_internal_forces(state_.q, state_.v, rest_force_);
    add(-1.0, model_->gap_rows().forces(force), rest_force_);
    a_ = rest_force_;
    mass_factor(*model_, massless_share * rule_.dt).solve(a_);
}

// With the predictors q~, v~ and q = q~ + d: S d + (1 - alpha) B^T N = (1 - alpha) (F - K q~ - C v~) + alpha
// r, r the force that accelerates at the beginning of the step; then a = d / (beta dt^2).
void Newmark::step(double time) {
    const std::int64_t z = model_->n_pairs();
    const double dt = rule_.dt, beta = rule_.beta, gamma = rule_.gamma, alpha = options_.alpha;
    set_sum({{1, state_.q}, {dt, state_.v}, {dt * dt * (0.5 - beta), a_}}, q_);
    set_sum({{1, state_.v}, {dt * (1 - gamma), a_}}, v_);
    excitation(time, load_);
    subtract_internal_forces(q_, v_, load_);
    set_sum({{rule_.now, load_}, {alpha, rest_force_}}, load_);
    step_.solve(load_); // d of the open structure
    if (z > 0) {
        set_sum({{1, q_}, {1, load_}}, work_);
        model_->gap_rows().of(work_, u_free_);
        subtract_gaps(time);
        contact_->solve(u_free_, contact_force_);
        add_combination(-rule_.now, response_, contact_force_, load_);
    }
    set_sum({{1, q_}, {1, load_}}, state_.q);
    set_sum({{1, v_}, {gamma / (beta * dt), load_}}, state_.v);
    set_sum({{1 / (beta * dt * dt), load_}}, a_);
    state_.time = time;
    if (alpha == 0) return;
    model_->mass_times(a_, work_); // M a = (1 - alpha) r + alpha r_before
    set_sum({{1 / rule_.now, work_}, {-alpha / rule_.now, rest_force_}}, rest_force_);
}

// omega^2 |dq|_M^2 + |dv|_M^2, the root of it.
double Newmark::distance(const FullState &a, const FullState &b) {
    const auto energy = [&](const Field &x, const Field &y) {
        set_sum({{1, x}, {-1, y}}, q_);
        model_->mass_times(q_, work_);
        return column_products(q_, work_)[0];
    };
    const double sum = omega_ * omega_ * energy(a.q, b.q) + energy(a.v, b.v);
    return std::sqrt(std::max(sum, 0.0));
}

NewmarkResult Newmark::run(const FullState &first, NewmarkObserver *observer) {
    start(first);
    const std::int64_t iterations = contact_->iterations(), factorizations = contact_->factorizations();
    const std::int64_t steps = options_.steps_per_period;
    const std::int64_t all = steps * options_.max_periods;
    NewmarkResult result;
    Settling settling(options_.settled, options_.period_multiple);
    FullState before = state_;
    for (std::int64_t done = 1; done <= all && !settling.settled(); ++done) {
        const double progress = static_cast<double>(done) / static_cast<double>(all);
        if (watch_.cancelled("time integration", progress)) {
            result.cancelled = true;
            break;
        }
        step(first.time + static_cast<double>(done) * rule_.dt);
        if (observer)
            observer->step({state_.time, state_.q, state_.v, a_, contact_force_, contact_->penetration()});
        const std::int64_t k = done - result.periods * steps;
        const bool quarter = k == steps / 4 || k == steps / 2 || k == steps / 4 * 3 || k == steps;
        if (quarter && settling.quarter(distance(state_, before))) before = state_;
        if (k == steps) ++result.periods;
    }
    require_finite_result(state_.q, "displacements of the time integration");
    require_finite_result(state_.v, "velocities of the time integration");
    result.change = settling.change();
    result.settled = settling.settled();
    result.state = state_;
    result.contact_iterations = contact_->iterations() - iterations;
    result.contact_factorizations = contact_->factorizations() - factorizations;
    return result;
}

} // namespace plm
