#include "orbits/exact_flow.hpp"
#include "contact/contact_step.hpp"
#include "contact/polynomial.hpp"
#include "linalg/lane_products.hpp"
#include "linalg/scale.hpp"
#include "linalg/work.hpp"
#include "orbits/orbit_cost.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double longest_step = 2.0; // rate x duration of a piece: about 26 terms, of which none exceeds 2
// Where events are dense, a piece is not made longer than its event lets it be used: terms are saved, and
// pairs that cannot come to zero so soon.
constexpr double shortest_try = 0.5; // rate x duration
constexpr double longer = 4;         // than the last one was used
// Where a stay in a contact set was no longer than so many pieces of the series, the next one is as likely
// to end with the first of them.
constexpr double dense = 2;
constexpr std::int64_t watch_interval = 64;                  // pieces
constexpr double least_advance = 0.05, shorter_piece = 0.25; // of a piece, in the modes of its contact set
// On symmetric structures pairs switch in twos and fours, apart by rounding: one event. The motion is off by
// the square of this.
constexpr double at_once = 1e-8;         // fraction of a piece
constexpr double no_progress = 1e-12;    // fraction of a piece
constexpr std::int64_t known_powers = 3; // of every pair's penetration: what one pass over the gap rows gives
constexpr double spare = 2;              // of the way of a pair: the bound itself is rounded
constexpr int side_corrections = 8;      // one is usual; more when pairs that rest at zero act on each other

} // namespace

ExactFlow::ExactFlow(std::shared_ptr<const FlowModel> model, double omega, double force_scale, Watch watch,
                     std::shared_ptr<ContactModesKept> modes)
    : model_(std::move(model)), omega_(omega), force_scale_(force_scale), watch_(watch), own_set_(*model_),
      events_(model_->contact(), model_->gap(), omega, force_scale), modes_(std::move(modes)),
      following_(model_->size()) {
    if (!(omega > 0 && std::isfinite(omega) && std::isfinite(force_scale)))
        throw Error(status::argument, "the flow needs a positive, finite frequency and a finite force scale")
            .argument("omega");
    for (const auto &entry : model_->excitation())
        fastest_force_ = std::max(fastest_force_, static_cast<double>(entry.first.harmonic) * omega);
    own_set_.assign_stiffest();
    shortest_series_ = longest_step / std::max(own_set_.rate(), fastest_force_);
    const double pairs = static_cast<double>(model_->n_pairs()), switches = own_set_.rate() * period() / M_PI;
    event_limit_ = static_cast<std::int64_t>(std::min(1000 + pairs * (100 + switches), 1e15));
}

void ExactFlow::check(const FlowState &state, double t_end) const {
    const std::size_t n = static_cast<std::size_t>(model_->size());
    if (state.y.size() != n || state.v.size() != n)
        throw Error(status::argument,
                    format("the state has %zu displacements and %zu velocities where the model has %zu",
                           state.y.size(), state.v.size(), n))
            .argument("state");
    double sum = state.time - state.time + (t_end - t_end);
    for (std::size_t j = 0; j < n; ++j) sum += (state.y[j] - state.y[j]) + (state.v[j] - state.v[j]);
    if (sum != 0) throw Error(status::argument, "NaN or Inf in the state or its times").argument("state");
    if (t_end < state.time)
        throw Error(status::argument, "the flow runs forward in time only").argument("t_end");
}

void ExactFlow::advance(FlowState &state, double t_end, FlowRecorder *recorder) {
    check(state, t_end);
    const double begin = state.time;
    events_left_ = static_cast<double>(event_limit_) * std::max(1.0, std::ceil((t_end - begin) / period()));
    stalled_ = 0;
    guess_contact(state);
    if (parameter_ != FlowParameter::none) {
        const vector<double> still(static_cast<std::size_t>(model_->size()), 0.0);
        change_ = {still, still, begin};
    }
    may_use_modes_ = model_->n_moving() > 0 && !(recorder && recorder->only_polynomials());
    if (may_use_modes_ && !modes_) modes_ = std::make_shared<ContactModesKept>(model_);
    if (may_use_modes_) modal_ = std::make_unique<ModalPieces>(*model_, omega_, force_scale_, parameter_);
    fresh_ = dense_ = true;
    last_event_ = begin;
    tried_ = INFINITY;
    while (state.time < t_end) {
        if (n_steps_++ % watch_interval == 0)
            watch_.step("exact flow", (state.time - begin) / (t_end - begin));
        const double left = t_end - state.time;
        if (may_use_modes_ && goes_by_modes(recorder) && enter_modes(state) &&
            (stay(state, left, recorder) || modal_piece(state, left, recorder)))
            continue;
        series_piece(state, left, recorder);
    }
    if (may_use_modes_ && modal_->inside()) modal_->leave(state, change_);
    if (may_use_modes_) fill_massless(state);
    require_finite_result(state.y.data(), model_->size(), "displacements of the exact flow");
    require_finite_result(state.v.data(), model_->size(), "velocities of the exact flow");
}

void ExactFlow::series_piece(FlowState &state, double left, FlowRecorder *recorder) {
    double duration = 0;
    for (int attempt = 0;; ++attempt) {
        take_set();
        duration = step_length(std::min(left, std::max(tried_, shortest_try / set_->rate())));
        expand(state, duration, motion_);
        if (attempt == side_corrections || !correct_sides(state, duration, motion_.penetrations)) break;
    }
    std::int64_t pair = -1;
    const double fraction = events_.first(motion_.penetrations, pair, at_once);
    if (recorder) report(state.time, fraction, duration, motion_.coefficient, nullptr, *recorder);
    move_to(state, fraction, duration, motion_.coefficient);
    if (parameter_ != FlowParameter::none && fraction > 0) {
        const double passed = step_length(fraction * duration);
        expand(change_, passed, derivative_);
        move_to(change_, 1.0, passed, derivative_.coefficient);
    }
    tried_ = longer * fraction * duration;
    events_.forget_zeros();
    fresh_ = false;
    if (pair >= 0) switch_pair(pair, fraction, state.time);
}

// The linear system of the present contact set, assembled anew where its modes are not known.
void ExactFlow::take_set() {
    taken_ = modes_ ? modes_->known(events_.states()) : nullptr;
    set_ = taken_ ? &taken_->set() : &own_set_;
    if (!taken_) own_set_.assign(events_.states());
}

// Right after an event where they are dense, a piece that needs its polynomials is cheaper by the series.
bool ExactFlow::goes_by_modes(FlowRecorder *recorder) const {
    if (modal_->inside() || !(fresh_ && dense_)) return true;
    const auto known = may_stay(recorder) ? modes_->known(events_.states()) : nullptr;
    return known && known->usable_in_single();
}

bool ExactFlow::enter_modes(const FlowState &state) {
    if (modal_->inside()) return true;
    auto modes = modes_->find(events_.states(), 1);
    return modes && modal_->enter(std::move(modes), state, change_);
}

// To the modes of the present set, where the way there is known. An impact lasts no longer than a piece of
// the series, which keeps the digits that stiff contact leaves the eigenvectors without.
bool ExactFlow::pass_on() {
    auto to = modes_->known(events_.states());
    if (!to || (dense_ && !(to->usable_in_single() && modal_->modes()->usable_in_single()))) return false;
    const vector<double> *way = modes_->known_transition(modal_->modes(), to);
    return way && modal_->pass(std::move(to), *way);
}

// False: a pair has left zero, or leaves it, by the other side or so slowly that the series has to say where
// it goes; nothing has moved.
bool ExactFlow::modal_piece(FlowState &state, double left, FlowRecorder *recorder) {
    double longest = std::min(left, 0.125 * period());
    for (;;) {
        worked(flops_of_piece());
        const double duration = modal_->expand(longest);
        if (events_.correct(modal_->penetrations(), modal_->rounding()) || !events_.leave_clearly()) {
            modal_->leave(state, change_);
            return false;
        }
        std::int64_t pair = -1;
        const double fraction = events_.first(modal_->penetrations(), pair);
        const bool veiled = pair >= 0 && modal_->is_veiled(pair);
        if (veiled && fraction < least_advance) { // shorter pieces see more
            longest = shorter_piece * duration;
            continue;
        }
        if (recorder) {
            const bool wanted = recorder->needs_motion();
            report(state.time, fraction, duration, wanted ? modal_->coefficient() : nothing_,
                   wanted ? &modal_->fast() : nullptr, *recorder);
        }
        modal_->advance(fraction * duration);
        state.time = modal_->now();
        events_.forget_zeros();
        fresh_ = false;
        if (pair < 0 || veiled) return true;
        switch_pair(pair, fraction, state.time);
        if (!pass_on()) modal_->leave(state, change_);
        return true;
    }
}

vector<double> ExactFlow::acceleration(const FlowState &state) {
    take_set();
    const double duration = step_length(0.125 * period());
    expand(state, duration, motion_);
    vector<double> a(static_cast<std::size_t>(model_->n_massive()));
    for (std::size_t j = 0; j < a.size(); ++j)
        a[j] = 2 * motion_.coefficient.col(2)[j] / (duration * duration);
    return a;
}

void ExactFlow::differentiate(FlowParameter parameter) {
    parameter_ = parameter;
}

void ExactFlow::switch_pair(std::int64_t pair, double fraction, double time) {
    const std::int64_t count = events_.pass();
    fresh_ = true;
    dense_ = time - last_event_ < dense * shortest_series_;
    last_event_ = time;
    n_events_ += count;
    stalled_ = fraction > no_progress ? 0 : stalled_ + 1;
    events_left_ -= static_cast<double>(count);
    if (events_left_ >= 0 && stalled_ <= 100 + 20 * model_->n_pairs()) return;
    throw Error(status::convergence,
                stalled_ > 0 ? format("contact events follow each other without end at t = %g s", time)
                             : format("more than %lld contact events per period; the last one at t = %g s",
                                      static_cast<long long>(event_limit_), time))
        .reason(reason::contact_chatter)
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
    expand_forces(state.time, 0.0, motion_);
    std::copy_n(motion_.offset.data(), z, u.data());
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
    fill_massless(state);
}

void ExactFlow::fill_massless(FlowState &state) {
    if (model_->n_massive() == model_->size()) return;
    take_set();
    const double duration = step_length(0.125 * period());
    expand(state, duration, motion_);
    for (std::int64_t j = model_->n_massive(); j < model_->size(); ++j) {
        state.y[j] = motion_.coefficient(j, 0);
        state.v[j] = motion_.coefficient(j, 1) / duration;
    }
}

// The series by products with the stiffness, the penetrations by one with the gap rows.
double ExactFlow::flops_of_piece() const {
    const double n = static_cast<double>(model_->size()), z = static_cast<double>(model_->n_pairs());
    return static_cast<double>(n_terms_) * (in_series * 2 * n * (n + z) + 10 * z) + 1e4;
}

double ExactFlow::step_length(double left) {
    const double rate = std::max(set_->rate(), fastest_force_);
    double duration = std::min(left, 0.125 * period());
    if (rate * duration > longest_step) duration = longest_step / rate;
    n_terms_ = std::min(taylor_terms(rate * duration, truncation_) + 3, max_polynomial_degree + 1);
    return duration;
}

// (k + 1)(k + 2) y_{k+2} = duration^2 (f_k - K y_k) - duration (k + 1) C y_{k+1}, powers of s = t / duration.
void ExactFlow::expand(const FlowState &state, double duration, Series &series) {
    worked(flops_of_piece());
    const std::int64_t n = model_->n_massive(), moving = model_->n_moving();
    expand_forces(state.time, duration, series);
    Matrix &y = series.coefficient;
    y.reset(model_->size(), n_terms_);
    for (std::int64_t j = 0; j < moving; ++j) {
        y(j, 0) = state.y[j];
        if (j < n) y(j, 1) = duration * state.v[j];
    }
    set_->relax(1, duration, y.col(0), series.force.col(0), y.col(1));
    for (std::int64_t k = 2; k < n_terms_; ++k) {
        const double order = static_cast<double>(k), factor = duration * duration / (order * (order - 1));
        const double *before = y.col(k - 1);
        double *next = y.col(k);
        multiply_and_add(set_->stiffness(), -factor, y.col(k - 2), factor, series.force.col(k - 2), next);
        if (model_->has_diagonal_damping()) {
            const vector<double> &c = model_->damping_diagonal();
            for (std::int64_t j = 0; j < n; ++j) next[j] -= duration / order * c[j] * before[j];
        } else {
            gemv('N', -duration / order, model_->damping(), before, 1.0, next);
        }
        set_->relax(k, duration, before, series.force.col(k - 1), next);
    }
    if (&series == &derivative_ && model_->n_following() == 0)
        return; // what it does to the gaps is not asked
    if (model_->n_following() > 0) {
        if (model_->n_pairs() > 0) gemm('N', 'N', 1.0, model_->gap(), y, 1.0, series.offset);
        follow(series);
        series.penetrations.expand(series.offset.transposed());
    } else {
        find_penetrations(series);
    }
}

// How far a pair may come nearer to zero: by its first powers, and by what the others have at most; what
// moves it besides the coordinates, where anything does, counts whole.
void ExactFlow::find_penetrations(Series &series) {
    const Matrix &y = series.coefficient;
    const std::int64_t z = model_->n_pairs();
    if (z == 0) return;
    known_.reshape(z, known_powers);
    ways_.assign(static_cast<std::size_t>(y.rows()), 0.0);
    for (std::int64_t k = known_powers; k < n_terms_; ++k)
        for (std::int64_t j = 0; j < y.rows(); ++j) ways_[j] += spare * std::abs(y(j, k));
    travel_.resize(static_cast<std::size_t>(z));
    multiply_three_and_bound(model_->gap(), y.data(), ways_.data(), known_.data(), travel_.data());
    now_.resize(static_cast<std::size_t>(z));
    for (std::int64_t i = 0; i < z; ++i) {
        now_[i] = series.offset(i, 0) + known_(i, 0);
        const double side = now_[i] > 0 ? 1 : -1;
        for (std::int64_t k = 1; k < known_powers; ++k)
            travel_[i] += spare * std::max(0.0, -side * known_(i, k));
        for (std::int64_t k = 1; k < series.offset.cols(); ++k)
            travel_[i] += spare * std::abs(series.offset(i, k));
    }
    series.penetrations.expand(now_, travel_, model_->gap_by_pair(), 'T', y, series.offset);
}

// What has neither mass nor damping: y = (f - G^T N) / k.
void ExactFlow::follow(Series &series) {
    const std::int64_t moving = model_->n_moving(), n = model_->n_following();
    set_->add_contact(series.offset, contact_force_);
    for (std::int64_t k = 0; k < n_terms_; ++k) {
        double *f = following_.data();
        std::copy_n(series.force.col(k) + moving, n, f + moving);
        if (model_->n_pairs() > 0) gemv('T', -1.0, model_->gap(), contact_force_.col(k), 1.0, f);
        for (std::int64_t j = moving; j < moving + n; ++j)
            series.coefficient(j, k) = f[j] / model_->lambda()[j];
    }
}

void ExactFlow::move_to(FlowState &state, double fraction, double duration, const Matrix &coefficient) const {
    const std::int64_t n = model_->size();
    std::fill(state.y.begin(), state.y.end(), 0.0);
    std::fill(state.v.begin(), state.v.end(), 0.0);
    for (std::int64_t k = n_terms_ - 1; k >= 0; --k) { // Horner for value and derivative
        const double *c = coefficient.col(k);
        for (std::int64_t j = 0; j < n; ++j) {
            state.v[j] = state.v[j] * fraction + state.y[j];
            state.y[j] = state.y[j] * fraction + c[j];
        }
    }
    for (std::int64_t j = 0; j < n; ++j) state.v[j] /= duration;
    state.time += fraction * duration;
}

void ExactFlow::report(double start, double fraction, double duration, const Matrix &coefficient,
                       const FastMotion *fast, FlowRecorder &recorder) {
    if (!(fraction > 0)) return;
    if (fraction == 1) {
        recorder.record({start, duration, coefficient, events_.states(), fast});
        return;
    }
    shortened_ = coefficient;
    double scale = 1;
    for (std::int64_t k = 0; k < shortened_.cols(); ++k, scale *= fraction)
        for (std::int64_t j = 0; j < shortened_.rows(); ++j) shortened_(j, k) *= scale;
    recorder.record({start, fraction * duration, shortened_, events_.states(), fast});
}

void ContactHistory::record(const FlowPiece &piece) {
    if (intervals_.empty() || intervals_.back().states != piece.states)
        intervals_.push_back({0.0, piece.states});
    intervals_.back().duration += piece.duration;
}

} // namespace plm
