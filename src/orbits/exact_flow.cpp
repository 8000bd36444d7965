#include "orbits/exact_flow.hpp"
#include "contact/contact_step.hpp"
#include "contact/polynomial.hpp"
#include "linalg/scale.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double longest_step = 2.0; // rate x duration of a piece: about 26 terms, of which none exceeds 2
constexpr double truncation = 1e-17;
constexpr std::int64_t watch_interval = 64; // pieces
constexpr double no_progress = 1e-12;       // fraction of a piece
constexpr int side_corrections = 8; // one is usual; more when pairs that rest at zero act on each other

} // namespace

ExactFlow::ExactFlow(std::shared_ptr<const FlowModel> model, double omega, double force_scale, Watch watch)
    : model_(std::move(model)), omega_(omega), force_scale_(force_scale), watch_(watch), system_(*model_),
      events_(model_->contact(), model_->gap()), following_(model_->size()) {
    if (!(omega > 0 && std::isfinite(omega) && std::isfinite(force_scale)))
        throw Error(PLM_ERR_ARGUMENT, "the flow needs a positive, finite frequency and a finite force scale")
            .argument("omega");
    for (const auto &entry : model_->excitation())
        fastest_force_ = std::max(fastest_force_, static_cast<double>(entry.first) * omega);
    system_.assign_stiffest();
    const double pairs = static_cast<double>(model_->n_pairs()), switches = system_.rate() * period() / M_PI;
    event_limit_ = static_cast<std::int64_t>(std::min(1000 + pairs * (100 + switches), 1e15));
}

void ExactFlow::check(const FlowState &state, double t_end) const {
    const std::size_t n = static_cast<std::size_t>(model_->size());
    if (state.y.size() != n || state.v.size() != n)
        throw Error(PLM_ERR_ARGUMENT,
                    format("the state has %zu displacements and %zu velocities where the model has %zu",
                           state.y.size(), state.v.size(), n))
            .argument("state");
    double sum = state.time - state.time + (t_end - t_end);
    for (std::size_t j = 0; j < n; ++j) sum += (state.y[j] - state.y[j]) + (state.v[j] - state.v[j]);
    if (sum != 0) throw Error(PLM_ERR_ARGUMENT, "NaN or Inf in the state or its times").argument("state");
    if (t_end < state.time)
        throw Error(PLM_ERR_ARGUMENT, "the flow runs forward in time only").argument("t_end");
}

void ExactFlow::advance(FlowState &state, double t_end, FlowRecorder *recorder) {
    check(state, t_end);
    const double begin = state.time;
    events_left_ = static_cast<double>(event_limit_) * std::max(1.0, std::ceil((t_end - begin) / period()));
    stalled_ = 0;
    guess_contact(state);
    while (state.time < t_end) {
        if (n_steps_++ % watch_interval == 0)
            watch_.step("exact flow", (state.time - begin) / (t_end - begin));
        worked(flops_of_piece());
        const double left = t_end - state.time;
        double duration = 0;
        for (int attempt = 0;; ++attempt) {
            system_.assign(events_.states());
            duration = step_length(left);
            expand(state, duration);
            if (attempt == side_corrections || !correct_sides(state, duration)) break;
        }
        std::int64_t pair = -1;
        const double fraction = events_.first(penetration_, pair);
        if (recorder) report(state, fraction, duration, *recorder);
        move_to(state, fraction, duration);
        events_.forget_zeros();
        if (pair >= 0) switch_pair(pair, fraction, state.time);
    }
    require_finite_result(state.y.data(), model_->size(), "displacements of the exact flow");
    require_finite_result(state.v.data(), model_->size(), "velocities of the exact flow");
}

void ExactFlow::switch_pair(std::int64_t pair, double fraction, double time) {
    events_.pass(pair);
    ++n_events_;
    stalled_ = fraction > no_progress ? 0 : stalled_ + 1;
    if (--events_left_ >= 0 && stalled_ <= 100 + 20 * model_->n_pairs()) return;
    throw Error(PLM_ERR_CONVERGENCE,
                stalled_ > 0 ? format("contact events follow each other without end at t = %g s", time)
                             : format("more than %lld contact events per period; the last one at t = %g s",
                                      static_cast<long long>(event_limit_), time))
        .reason(PLM_REASON_CONTACT_CHATTER)
        .index(pair);
}

// By the penetration alone; pairs at zero get their side from the series. What follows without mass is where
// the present forces put it, the contact's among them.
void ExactFlow::guess_contact(const FlowState &state) {
    events_.forget_zeros();
    const std::int64_t z = model_->n_pairs();
    if (z == 0) return;
    vector<double> moving(state.y), u(z);
    std::fill(moving.begin() + model_->n_moving(), moving.end(), 0.0);
    n_terms_ = 1;
    expand_forces(state.time, 0.0);
    std::copy_n(offset_.data(), z, u.data());
    gemv('N', 1.0, model_->gap(), moving.data(), 1.0, u.data());
    if (model_->n_following() > 0) {
        ContactStep step(model_->flexibility(), model_->contact_stiffness());
        vector<double> force(z, 0.0);
        step.solve(u, force);
        u = step.penetration();
    }
    events_.guess(u);
}

void ExactFlow::complete(FlowState &state) {
    if (model_->n_massive() == model_->size()) return;
    guess_contact(state);
    system_.assign(events_.states());
    const double duration = step_length(0.125 * period());
    expand(state, duration);
    for (std::int64_t j = model_->n_massive(); j < model_->size(); ++j) {
        state.y[j] = coefficient_(j, 0);
        state.v[j] = coefficient_(j, 1) / duration;
    }
}

// The series by products with the stiffness, the penetrations by one with the gap rows.
double ExactFlow::flops_of_piece() const {
    const double n = static_cast<double>(model_->size()), z = static_cast<double>(model_->n_pairs());
    return static_cast<double>(n_terms_) * (2 * n * (n + z) + 100 * z) + 1e4;
}

double ExactFlow::step_length(double left) {
    const double rate = std::max(system_.rate(), fastest_force_);
    double duration = std::min(left, 0.125 * period());
    if (rate * duration > longest_step) duration = longest_step / rate;
    n_terms_ = std::min(taylor_terms(rate * duration, truncation) + 3, max_polynomial_degree + 1);
    return duration;
}

// (k + 1)(k + 2) y_{k+2} = duration^2 (f_k - K y_k) - duration (k + 1) C y_{k+1}, powers of s = t / duration.
void ExactFlow::expand(const FlowState &state, double duration) {
    const std::int64_t n = model_->n_massive(), moving = model_->n_moving();
    expand_forces(state.time, duration);
    coefficient_.reset(model_->size(), n_terms_);
    for (std::int64_t j = 0; j < moving; ++j) {
        coefficient_(j, 0) = state.y[j];
        if (j < n) coefficient_(j, 1) = duration * state.v[j];
    }
    system_.relax(1, duration, coefficient_.col(0), force_.col(0), coefficient_.col(1));
    for (std::int64_t k = 2; k < n_terms_; ++k) {
        const double order = static_cast<double>(k), factor = duration * duration / (order * (order - 1));
        const double *before = coefficient_.col(k - 1);
        double *next = coefficient_.col(k);
        std::copy_n(force_.col(k - 2), moving, next);
        gemv('N', -factor, system_.stiffness(), coefficient_.col(k - 2), factor, next);
        if (model_->has_diagonal_damping()) {
            const vector<double> &c = model_->damping_diagonal();
            for (std::int64_t j = 0; j < n; ++j) next[j] -= duration / order * c[j] * before[j];
        } else {
            gemv('N', -duration / order, model_->damping(), before, 1.0, next);
        }
        system_.relax(k, duration, before, force_.col(k - 1), next);
    }
    penetration_ = offset_;
    if (model_->n_pairs() > 0) gemm('N', 'N', 1.0, model_->gap(), coefficient_, 1.0, penetration_);
    follow();
}

// What has neither mass nor damping: y = (f - G^T N) / k.
void ExactFlow::follow() {
    const std::int64_t moving = model_->n_moving(), n = model_->n_following();
    if (n == 0) return;
    system_.add_contact(penetration_, contact_force_);
    for (std::int64_t k = 0; k < n_terms_; ++k) {
        double *f = following_.data();
        std::copy_n(force_.col(k) + moving, n, f + moving);
        if (model_->n_pairs() > 0) gemv('T', -1.0, model_->gap(), contact_force_.col(k), 1.0, f);
        for (std::int64_t j = moving; j < moving + n; ++j) coefficient_(j, k) = f[j] / model_->lambda()[j];
    }
}

// Taylor coefficients of all forces but K y: Re(F_h exp(i h w t)) has F_h exp(i h w t_0) (i h w duration)^k /
// k!. The gaps act through the springs of the pairs, too, and so does what the forces do at the
// contact by themselves where there is no mass.
void ExactFlow::expand_forces(double time, double duration) {
    const std::int64_t n = model_->size();
    const std::int64_t count = model_->n_massive() < n ? n_terms_ : std::max<std::int64_t>(n_terms_ - 2, 1);
    force_.reset(n, n_terms_);
    for (std::int64_t j = 0; j < n; ++j) force_(j, 0) = model_->preload()[j];
    for (const auto &[harmonic, load] : model_->excitation()) {
        const double step = static_cast<double>(harmonic) * omega_ * duration;
        std::complex<double> z = std::polar(force_scale_, static_cast<double>(harmonic) * omega_ * time);
        for (std::int64_t k = 0; k < count; ++k) {
            double *f = force_.col(k);
            for (std::int64_t j = 0; j < n; ++j) f[j] += z.real() * load.real[j];
            if (harmonic == 0) break;
            for (std::int64_t j = 0; j < n; ++j) f[j] -= z.imag() * load.imag[j];
            z *= std::complex<double>(0.0, step / static_cast<double>(k + 1));
        }
    }
    expand_offsets();
    still_.reset(model_->n_pairs(), model_->n_following() > 0 ? n_terms_ : 1);
    if (model_->n_pairs() == 0) return;
    std::copy_n(offset_.data(), still_.rows() * still_.cols(), still_.data());
    system_.add_contact(still_, contact_force_);
    for (std::int64_t k = 0; k < still_.cols(); ++k) {
        gemv('T', -1.0, model_->gap(), contact_force_.col(k), 0.0, following_.data());
        for (std::int64_t j = 0; j < model_->n_moving(); ++j) force_(j, k) += following_[j];
    }
}

// Penetrations with the moving coordinates at zero, without contact forces.
void ExactFlow::expand_offsets() {
    const std::int64_t moving = model_->n_moving(), n = model_->n_following(), z = model_->n_pairs();
    offset_.reset(z, n_terms_);
    std::fill(following_.begin(), following_.end(), 0.0);
    for (std::int64_t k = 0; k < n_terms_ && n > 0 && z > 0; ++k) {
        for (std::int64_t j = moving; j < moving + n; ++j) following_[j] = force_(j, k) / model_->lambda()[j];
        gemv('N', 1.0, model_->gap(), following_.data(), 0.0, offset_.col(k));
    }
    for (std::int64_t i = 0; i < z; ++i) offset_(i, 0) -= model_->initial_gap()[i];
}

bool ExactFlow::correct_sides(const FlowState &state, double duration) {
    const std::int64_t n = model_->size();
    return events_.correct(penetration_, norm2(n, state.y.data()) + duration * norm2(n, state.v.data()));
}

void ExactFlow::move_to(FlowState &state, double fraction, double duration) {
    const std::int64_t n = model_->size();
    std::fill(state.y.begin(), state.y.end(), 0.0);
    std::fill(state.v.begin(), state.v.end(), 0.0);
    for (std::int64_t k = n_terms_ - 1; k >= 0; --k) { // Horner for value and derivative
        const double *c = coefficient_.col(k);
        for (std::int64_t j = 0; j < n; ++j) {
            state.v[j] = state.v[j] * fraction + state.y[j];
            state.y[j] = state.y[j] * fraction + c[j];
        }
    }
    for (std::int64_t j = 0; j < n; ++j) state.v[j] /= duration;
    state.time += fraction * duration;
}

void ExactFlow::report(const FlowState &state, double fraction, double duration, FlowRecorder &recorder) {
    if (!(fraction > 0)) return;
    if (fraction == 1) {
        recorder.record({state.time, duration, coefficient_, events_.states()});
        return;
    }
    shortened_ = coefficient_;
    double scale = 1;
    for (std::int64_t k = 0; k < n_terms_; ++k, scale *= fraction)
        for (std::int64_t j = 0; j < model_->size(); ++j) shortened_(j, k) *= scale;
    recorder.record({state.time, fraction * duration, shortened_, events_.states()});
}

void ContactHistory::record(const FlowPiece &piece) {
    if (intervals_.empty() || intervals_.back().states != piece.states)
        intervals_.push_back({0.0, piece.states});
    intervals_.back().duration += piece.duration;
}

void PeakRecorder::record(const FlowPiece &piece) {
    const std::int64_t degree = piece.coefficient.cols() - 1;
    values_.reset(rows_.rows(), degree + 1);
    if (rows_.rows() == 0) return;
    gemm('N', 'N', 1.0, rows_, piece.coefficient, 0.0, values_);
    polynomial_.resize(degree + 1);
    for (std::int64_t i = 0; i < rows_.rows(); ++i) {
        for (std::int64_t k = 0; k <= degree; ++k) polynomial_[k] = values_(i, k);
        peak_[i] = largest_magnitude(polynomial_.data(), degree, peak_[i]);
    }
}

} // namespace plm
