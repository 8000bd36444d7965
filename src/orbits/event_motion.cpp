#include "orbits/event_motion.hpp"
#include "linalg/lapack.hpp"
#include "orbits/period_map.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using complex = std::complex<double>;

constexpr double longest_move = 0.02; // of the period
constexpr double wrong_side = 1e-3;   // of the largest penetration or gap: an event was missed

vector<double> applied(const Matrix &m, const vector<double> &x) {
    vector<double> y(m.rows());
    gemv('N', 1.0, m, x.data(), 0.0, y.data());
    return y;
}

bool is_finite(const vector<double> &x) {
    return std::all_of(x.begin(), x.end(), [](double v) { return std::isfinite(v); });
}

} // namespace

struct EventMotion::Steady {
    vector<double> mean;                                   // n
    std::vector<std::pair<double, vector<complex>>> waves; // frequency, n: Re(q exp(i frequency t))
};

EventMotion::EventMotion(const FlowModel &model, double omega, double force_scale, std::int64_t periods,
                         const Matrix &within)
    : model_(model), omega_(omega), force_scale_(force_scale),
      period_(2 * M_PI / omega * static_cast<double>(periods)), within_(within), n_(model.size()),
      set_(model) {}

// Of all coordinates, those that only follow included: diag(lambda) + G_A^T k G_A.
Matrix EventMotion::stiffness_of(const vector<char> &closed) const {
    Matrix rows = model_.gap(), stiffness(n_, n_);
    for (std::int64_t p = 0; p < rows.rows(); ++p) {
        const double root = closed[p] ? std::sqrt(model_.contact_stiffness()[p]) : 0.0;
        for (std::int64_t j = 0; j < n_; ++j) rows(p, j) *= root;
    }
    if (rows.rows() > 0) gemm('T', 'N', 1.0, rows, rows, 0.0, stiffness);
    for (std::int64_t j = 0; j < n_; ++j) stiffness(j, j) += model_.lambda()[j];
    return stiffness;
}

vector<complex> EventMotion::wave(const Matrix &stiffness, double w, const HarmonicLoad &load) const {
    vector<complex> a(n_ * n_), q(n_);
    for (std::int64_t j = 0; j < n_; ++j) {
        for (std::int64_t i = 0; i < n_; ++i)
            a[i + j * n_] = {stiffness(i, j),
                             model_.has_diagonal_damping() ? 0.0 : w * model_.damping()(i, j)};
        a[j + j * n_] += complex(-w * w * model_.mass(j),
                                 model_.has_diagonal_damping() ? w * model_.damping_diagonal()[j] : 0.0);
        q[j] = force_scale_ * complex(load.real[j], load.imag[j]);
    }
    ComplexLu lu;
    lu.factor(n_, a);
    lu.solve(q.data(), 1, n_);
    return q;
}

// What pre-load, mean excitation and the gaps of the closed pairs do, then each harmonic. Null: the system of
// this set is singular.
const EventMotion::Steady *EventMotion::steady(const vector<char> &closed) {
    for (const auto &[set, response] : known_)
        if (set == closed) return response.get();
    Matrix stiffness = stiffness_of(closed);
    auto found = std::make_shared<Steady>();
    found->mean = model_.preload();
    for (std::int64_t p = 0; p < model_.n_pairs(); ++p)
        for (std::int64_t j = 0; closed[p] && j < n_; ++j)
            found->mean[j] += model_.gap()(p, j) * model_.contact_stiffness()[p] * model_.initial_gap()[p];
    for (const auto &[harmonic, load] : model_.excitation()) {
        const double w = static_cast<double>(harmonic) * omega_;
        if (harmonic != 0) found->waves.emplace_back(w, wave(stiffness, w, load));
        for (std::int64_t j = 0; harmonic == 0 && j < n_; ++j) found->mean[j] += force_scale_ * load.real[j];
    }
    RealLu lu;
    lu.factor(stiffness);
    if (lu.singular()) return nullptr;
    lu.solve(found->mean.data(), 1, n_);
    known_.emplace_back(closed, std::move(found));
    return known_.back().second.get();
}

EventMotion::Whole EventMotion::at(const Steady &steady, double time) const {
    Whole whole{steady.mean, vector<double>(n_, 0.0)};
    for (const auto &[w, q] : steady.waves) {
        const complex turn = std::polar(1.0, w * time);
        for (std::int64_t j = 0; j < n_; ++j) {
            const complex now = q[j] * turn;
            whole.y[j] += now.real();
            whole.v[j] -= w * now.imag();
        }
    }
    return whole;
}

vector<double> EventMotion::state_of(const Whole &whole) const {
    vector<double> state(whole.y.begin(), whole.y.begin() + model_.n_moving());
    state.insert(state.end(), whole.v.begin(), whole.v.begin() + model_.n_massive());
    return state;
}

// The free motion dies away, the steady response takes its place: state - before through the propagator, plus
// after.
void EventMotion::pass(const Piece &piece, vector<double> &state) const {
    const vector<double> before = state_of(piece.before), after = state_of(piece.after);
    for (std::size_t j = 0; j < state.size(); ++j) state[j] -= before[j];
    state = applied(piece.propagator, state);
    for (std::size_t j = 0; j < state.size(); ++j) state[j] += after[j];
}

bool EventMotion::add_piece(const vector<char> &closed, double from, double to, vector<double> &offset) {
    const Steady *response = steady(closed);
    if (!response) return false;
    pieces_.push_back(
        {plm::monodromy(model_, {{to - from, closed}}), at(*response, from), at(*response, to)});
    const Matrix &propagator = pieces_.back().propagator;
    pass(pieces_.back(), offset);
    monodromy_ = monodromy_.rows() == 0 ? propagator : product('N', 'N', propagator, monodromy_);
    return true;
}

// Penetrations (first column) and their rates: of the steady response, and of the free motion beside it, in
// which what has no mass is where the rest and the contact put it.
Matrix EventMotion::penetrations(const Whole &steady, const vector<double> &state,
                                 const vector<char> &closed) {
    const std::int64_t moving = model_.n_moving(), massive = model_.n_massive(), z = model_.n_pairs();
    const vector<double> at_rest = state_of(steady);
    vector<double> y(n_, 0.0), v(n_, 0.0);
    for (std::int64_t j = 0; j < moving; ++j) y[j] = state[j] - at_rest[j];
    for (std::int64_t j = 0; j < massive; ++j) v[j] = state[moving + j] - at_rest[moving + j];
    set_.assign(closed);
    set_.relax(1, 1.0, y.data(), nullptr, v.data());
    Matrix u(z, 2), force;
    gemv('N', 1.0, model_.gap(), y.data(), 0.0, u.col(0));
    gemv('N', 1.0, model_.gap(), v.data(), 0.0, u.col(1));
    set_.add_contact(u, force);
    gemv('N', 1.0, model_.gap(), steady.y.data(), 1.0, u.col(0));
    gemv('N', 1.0, model_.gap(), steady.v.data(), 1.0, u.col(1));
    for (std::int64_t p = 0; p < z; ++p) u(p, 0) -= model_.initial_gap()[p];
    return u;
}

void EventMotion::look_at_event(const Matrix &u, const ContactEvent &event, const vector<char> &closed) {
    for (std::int64_t p = 0; p < u.rows(); ++p) {
        largest_ = std::max(largest_, std::abs(u(p, 0)));
        if (p != event.pair) worst_ = std::max(worst_, closed[p] ? -u(p, 0) : u(p, 0));
    }
    shifts_.push_back(-u(event.pair, 0) / u(event.pair, 1));
    shift_ = std::max(shift_, std::abs(shifts_.back()) * omega_);
}

bool EventMotion::solve(const EventSequence &sequence) {
    pieces_.clear();
    shifts_.clear();
    monodromy_ = Matrix();
    size_ = shift_ = largest_ = worst_ = 0;
    vector<char> closed = sequence.closed_first;
    vector<double> offset(model_.state_size(), 0.0);
    double time = 0;
    for (const ContactEvent &event : sequence.events) {
        if (!add_piece(closed, time, event.time, offset)) return false;
        closed[event.pair] ^= 1;
        time = event.time;
    }
    if (!add_piece(closed, time, period_, offset)) return false;
    const FlowState zero{vector<double>(n_, 0.0), vector<double>(n_, 0.0), 0};
    PeriodRun run;
    run.end = plm::moved(model_, zero, offset, 1);
    vector<double> state = period_step(model_, zero, run, monodromy_, within_);
    if (!is_finite(state)) return false;
    start_ = plm::moved(model_, zero, state, 1);
    closed = sequence.closed_first;
    const EnergyNorm norm(model_, omega_);
    for (std::size_t k = 0; k < sequence.events.size(); ++k) {
        const ContactEvent &event = sequence.events[k];
        pass(pieces_[k], state);
        look_at_event(penetrations(pieces_[k].after, state, closed), event, closed);
        closed[event.pair] ^= 1;
        size_ = std::max(size_, norm.distance(plm::moved(model_, zero, state, 1), start_));
    }
    consistent_ = worst_ <= wrong_side * largest_;
    return std::isfinite(shift_) && std::isfinite(size_);
}

// An event that leaves the period comes in at its other end: its pair is then on the other side at time 0.
EventSequence EventMotion::moved(const EventSequence &sequence) const {
    EventSequence next = sequence;
    for (std::size_t k = 0; k < next.events.size(); ++k) {
        ContactEvent &event = next.events[k];
        event.time += std::clamp(shifts_[k], -longest_move * period_, longest_move * period_);
        if (event.time >= 0 && event.time <= period_) continue;
        event.time += event.time < 0 ? period_ : -period_;
        next.closed_first[event.pair] ^= 1;
    }
    std::stable_sort(next.events.begin(), next.events.end(),
                     [](const ContactEvent &a, const ContactEvent &b) { return a.time < b.time; });
    return next;
}

} // namespace plm
