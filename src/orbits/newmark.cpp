#include "orbits/newmark.hpp"
#include "linalg/scale.hpp"
#include "orbits/settling.hpp"
#include "space/rest.hpp"
#include "structure/solver/make_factor.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double massless_share = 1e-3; // of a step: how long mass-less DOFs take to their first equilibrium

void refuse(const char *name, const std::string &text) {
    throw Error(PLM_ERR_ARGUMENT, text).argument(name);
}

void check(const Model &model, double omega, const NewmarkOptions &o) {
    if (!(omega > 0 && std::isfinite(omega))) refuse("omega", "the frequency must be positive and finite");
    if (!std::isfinite(o.force_scale)) refuse("force_scale", "the force scale is not finite");
    if (!(o.alpha >= 0 && o.alpha <= 1.0 / 3)) refuse("alpha", "alpha must lie between 0 and 1/3");
    if (o.steps_per_period < 4) refuse("steps_per_period", "a period needs at least 4 steps");
    if (o.max_periods < 1) refuse("max_periods", "max_periods must be at least 1");
    if (!(o.settled >= 0)) refuse("settled", "the tolerance must not be negative");
    if (o.period_multiple < 1) refuse("period_multiple", "period_multiple must be at least 1");
    for (double ratio : model.damping().modal_ratio)
        if (ratio != 0)
            refuse("modal_ratio",
                   "time integration of the full model takes Rayleigh damping, an explicit C or "
                   "structural damping; modal damping has no sparse form");
}

bool same_size(const vector<double> &x, std::int64_t n) {
    return static_cast<std::int64_t>(x.size()) == n;
}

bool all_finite(const vector<double> &x) {
    return std::all_of(x.begin(), x.end(), [](double v) { return std::isfinite(v); });
}

// The mass matrix, or where DOFs have no mass, with so much stiffness that they follow within `time`.
std::unique_ptr<Factor> mass_factor(const Model &model, double time) {
    const SparseMatrix &mass = model.mass();
    vector<char> has_mass(mass.cols, 0);
    for (std::int64_t j = 0; j < mass.cols; ++j)
        for (std::int64_t p = mass.ptr[j]; p < mass.ptr[j + 1]; ++p)
            if (mass.idx[p] == j && mass.val[p] > 0) has_mass[j] = 1;
    if (std::all_of(has_mass.begin(), has_mass.end(), [](char b) { return b != 0; })) {
        try {
            return make_factor(mass, FactorKind::positive_definite, model.host_solver());
        } catch (const Error &e) { // singular all the same
            if (e.status() != PLM_ERR_NOT_POSITIVE_DEFINITE) throw;
        }
    }
    return make_factor(add(1.0, mass, time * time, model.stiffness()), FactorKind::positive_definite,
                       model.host_solver());
}

} // namespace

Newmark::Newmark(std::shared_ptr<const Model> model, double omega, const NewmarkOptions &options, Watch watch)
    : model_(std::move(model)), omega_(omega), options_(options), watch_(watch) {
    check(*model_, omega, options);
    now_ = 1 - options.alpha;
    beta_ = 0.25 * (1 + options.alpha) * (1 + options.alpha);
    gamma_ = 0.5 + options.alpha;
    dt_ = 2 * M_PI / omega / static_cast<double>(options.steps_per_period);
    assemble_damping();
    factor_step();
}

void Newmark::assemble_damping() {
    const Damping &d = model_->damping();
    const double beta = d.beta + d.structural / omega_;
    if (d.alpha != 0 || beta != 0) damping_ = add(d.alpha, model_->mass(), beta, model_->stiffness());
    if (!d.has_matrix) return;
    damping_ =
        damping_.rows > 0 ? add(1.0, damping_, 1.0, model_->damping_matrix()) : model_->damping_matrix();
}

// S = M / (beta dt^2) + (1 - alpha) (gamma / (beta dt) C + K) and its flexibility at the contact.
void Newmark::factor_step() {
    watch_.step("time integration", 0.0);
    SparseMatrix s = add(1 / (beta_ * dt_ * dt_), model_->mass(), now_, model_->stiffness());
    if (damping_.rows > 0) s = add(1.0, s, now_ * gamma_ / (beta_ * dt_), damping_);
    factor_ = make_factor(s, FactorKind::positive_definite, model_->host_solver());
    response_ = to_dense(transpose(model_->gap_matrix()));
    Matrix flexibility;
    if (model_->n_pairs() > 0) {
        factor_->solve(response_);
        flexibility = multiply(model_->gap_matrix(), response_);
        for (std::int64_t j = 0; j < flexibility.cols(); ++j)
            for (std::int64_t i = 0; i <= j; ++i)
                flexibility(i, j) = flexibility(j, i) = 0.5 * now_ * (flexibility(i, j) + flexibility(j, i));
    }
    contact_ = std::make_unique<ContactStep>(std::move(flexibility), model_->contact_stiffness());
}

FullState rest_state(const std::shared_ptr<const Model> &model, Watch watch) {
    const std::int64_t n = model->n_free();
    FullState state{vector<double>(n, 0.0), vector<double>(n, 0.0), 0};
    if (model->has_preload() || model->contact().has_interference())
        state.q = solve_rest(*make_contact_space(model, 0.0, 1, watch)).displacement;
    return state;
}

// Pre-load and Re(F_h exp(i h w t)).
void Newmark::excitation(double time, vector<double> &f) const {
    std::fill(f.begin(), f.end(), 0.0);
    if (model_->has_preload()) f = model_->preload();
    for (const auto &[harmonic, load] : model_->excitation()) {
        const double phase = static_cast<double>(harmonic) * omega_ * time;
        const double c = options_.force_scale * std::cos(phase), s = options_.force_scale * std::sin(phase);
        for (std::size_t i = 0; i < f.size(); ++i) f[i] += c * load.real[i];
        if (harmonic == 0) continue;
        for (std::size_t i = 0; i < f.size(); ++i) f[i] -= s * load.imag[i];
    }
}

// Forces and acceleration that go with the first state.
void Newmark::start(const FullState &state) {
    const std::int64_t n = model_->n_free(), z = model_->n_pairs();
    if (!same_size(state.q, n) || !same_size(state.v, n) || !all_finite(state.q) || !all_finite(state.v) ||
        !std::isfinite(state.time))
        refuse("start", format("the first state needs %lld finite displacements and velocities (free DOFs)",
                               static_cast<long long>(n)));
    state_ = state;
    for (vector<double> *x : {&a_, &rest_force_, &q_, &v_, &load_, &work_}) x->assign(n, 0.0);
    u_free_.assign(z, 0.0);
    contact_force_.assign(z, 0.0);
    multiply(model_->gap_matrix(), state_.q.data(), u_free_.data());
    for (std::int64_t i = 0; i < z; ++i)
        contact_force_[i] = model_->contact().force(i, u_free_[i] - model_->initial_gap()[i]);
    excitation(state_.time, rest_force_);
    multiply(model_->stiffness(), state_.q.data(), work_.data());
    for (std::int64_t i = 0; i < n; ++i) rest_force_[i] -= work_[i];
    if (damping_.rows > 0) multiply(damping_, state_.v.data(), work_.data());
    for (std::int64_t i = 0; i < n && damping_.rows > 0; ++i) rest_force_[i] -= work_[i];
    multiply_transposed(model_->gap_matrix(), contact_force_.data(), work_.data());
    for (std::int64_t i = 0; i < n; ++i) rest_force_[i] -= work_[i];
    a_ = rest_force_;
    mass_factor(*model_, massless_share * dt_)->solve(a_.data(), 1, n);
}

// With the predictors q~, v~ and q = q~ + d: S d + (1 - alpha) B^T N = (1 - alpha) (F - K q~ - C v~) + alpha
// r, r the force that accelerates at the beginning of the step; then a = d / (beta dt^2).
void Newmark::step(double time) {
    const std::int64_t n = model_->n_free(), z = model_->n_pairs();
    for (std::int64_t i = 0; i < n; ++i) {
        q_[i] = state_.q[i] + dt_ * (state_.v[i] + dt_ * (0.5 - beta_) * a_[i]);
        v_[i] = state_.v[i] + dt_ * (1 - gamma_) * a_[i];
    }
    excitation(time, load_);
    multiply(model_->stiffness(), q_.data(), work_.data());
    for (std::int64_t i = 0; i < n; ++i) load_[i] -= work_[i];
    if (damping_.rows > 0) multiply(damping_, v_.data(), work_.data());
    for (std::int64_t i = 0; i < n && damping_.rows > 0; ++i) load_[i] -= work_[i];
    for (std::int64_t i = 0; i < n; ++i) load_[i] = now_ * load_[i] + options_.alpha * rest_force_[i];
    factor_->solve(load_.data(), 1, n); // d of the open structure
    if (z > 0) {
        for (std::int64_t i = 0; i < n; ++i) work_[i] = q_[i] + load_[i];
        multiply(model_->gap_matrix(), work_.data(), u_free_.data());
        for (std::int64_t i = 0; i < z; ++i) u_free_[i] -= model_->initial_gap()[i];
        contact_->solve(u_free_, contact_force_);
        gemv('N', -now_, response_, contact_force_.data(), 1.0, load_.data());
    }
    const double to_velocity = gamma_ / (beta_ * dt_), to_acceleration = 1 / (beta_ * dt_ * dt_);
    for (std::int64_t i = 0; i < n; ++i) {
        state_.q[i] = q_[i] + load_[i];
        state_.v[i] = v_[i] + to_velocity * load_[i];
        a_[i] = to_acceleration * load_[i];
    }
    state_.time = time;
    if (options_.alpha == 0) return;
    multiply(model_->mass(), a_.data(), work_.data()); // M a = (1 - alpha) r + alpha r_before
    for (std::int64_t i = 0; i < n; ++i) rest_force_[i] = (work_[i] - options_.alpha * rest_force_[i]) / now_;
}

// omega^2 |dq|_M^2 + |dv|_M^2, the root of it.
double Newmark::distance(const FullState &a, const FullState &b) {
    const std::int64_t n = model_->n_free();
    double sum = 0;
    for (std::int64_t i = 0; i < n; ++i) q_[i] = a.q[i] - b.q[i];
    multiply(model_->mass(), q_.data(), work_.data());
    sum += omega_ * omega_ * dot(n, q_.data(), work_.data());
    for (std::int64_t i = 0; i < n; ++i) q_[i] = a.v[i] - b.v[i];
    multiply(model_->mass(), q_.data(), work_.data());
    sum += dot(n, q_.data(), work_.data());
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
        const double share = static_cast<double>(done) / static_cast<double>(all);
        if (watch_.cancelled("time integration", share)) {
            result.cancelled = true;
            break;
        }
        step(first.time + static_cast<double>(done) * dt_);
        if (observer)
            observer->step({state_.time, state_.q, state_.v, a_, contact_force_, contact_->penetration()});
        const std::int64_t k = done - result.periods * steps;
        const bool quarter = k == steps / 4 || k == steps / 2 || k == steps / 4 * 3 || k == steps;
        if (quarter && settling.quarter(distance(state_, before))) before = state_;
        if (k == steps) ++result.periods;
    }
    require_finite_result(state_.q.data(), model_->n_free(), "displacements of the time integration");
    require_finite_result(state_.v.data(), model_->n_free(), "velocities of the time integration");
    result.change = settling.change();
    result.settled = settling.settled();
    result.state = state_;
    result.contact_iterations = contact_->iterations() - iterations;
    result.contact_factorizations = contact_->factorizations() - factorizations;
    return result;
}

DofRecorder::DofRecorder(std::shared_ptr<const Model> model, const vector<std::int64_t> &dofs) {
    for (std::int64_t dof : dofs) {
        if (dof < 0 || dof >= model->n_dof())
            throw Error(PLM_ERR_ARGUMENT,
                        format("DOF %lld is not one of 0 .. %lld", static_cast<long long>(dof),
                               static_cast<long long>(model->n_dof() - 1)))
                .argument("dof")
                .index(dof);
        rows_.push_back(model->free_index(dof));
    }
}

void DofRecorder::step(const NewmarkStep &step) {
    times_.push_back(step.time);
    for (std::int64_t row : rows_) values_.push_back(row < 0 ? 0.0 : step.q[row]);
}

} // namespace plm
