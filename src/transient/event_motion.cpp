#include "transient/event_motion.hpp"
#include "linalg/lapack.hpp"
#include "transient/period_map.hpp"
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

// What pre-load, mean excitation and the gaps of the closed pairs do, then each harmonic. Null: the system of
// this set is singular.
const EventMotion::Steady *EventMotion::steady(const vector<char> &closed) {
    for (const auto &[set, response] : known_)
        if (set == closed) return response.get();
    set_.assign(closed);
    auto found = std::make_shared<Steady>();
    found->mean = model_.preload();
    if (model_.n_pairs() > 0) {
        Matrix still(model_.n_pairs(), 1), force;
        for (std::int64_t p = 0; p < still.rows(); ++p) still(p, 0) = -model_.initial_gap()[p];
        set_.add_contact(still, force);
        gemv('T', -1.0, model_.gap(), force.data(), 1.0, found->mean.data());
    }
    Matrix stiffness = set_.stiffness();
    for (const auto &[harmonic, load] : model_.excitation()) {
        if (harmonic == 0) {
            for (std::int64_t j = 0; j < n_; ++j) found->mean[j] += force_scale_ * load.real[j];
            continue;
        }
        const double w = static_cast<double>(harmonic) * omega_;
        vector<complex> a(n_ * n_), q(n_);
        for (std::int64_t j = 0; j < n_; ++j) {
            for (std::int64_t i = 0; i < n_; ++i)
                a[i + j * n_] = {stiffness(i, j),
                                 model_.has_diagonal_damping() ? 0.0 : w * model_.damping()(i, j)};
            a[j + j * n_] +=
                complex(-w * w, model_.has_diagonal_damping() ? w * model_.damping_diagonal()[j] : 0.0);
            q[j] = force_scale_ * complex(load.real[j], load.imag[j]);
        }
        ComplexLu lu;
        lu.factor(n_, a);
        lu.solve(q.data(), 1, n_);
        found->waves.emplace_back(w, std::move(q));
    }
    RealLu lu;
    lu.factor(stiffness);
    if (lu.singular()) return nullptr;
    lu.solve(found->mean.data(), 1, n_);
    known_.emplace_back(closed, std::move(found));
    return known_.back().second.get();
}

vector<double> EventMotion::at(const Steady &steady, double time) const {
    vector<double> state(2 * n_, 0.0);
    std::copy(steady.mean.begin(), steady.mean.end(), state.begin());
    for (const auto &[w, q] : steady.waves) {
        const complex turn = std::polar(1.0, w * time);
        for (std::int64_t j = 0; j < n_; ++j) {
            const complex now = q[j] * turn;
            state[j] += now.real();
            state[n_ + j] -= w * now.imag();
        }
    }
    return state;
}

bool EventMotion::add_piece(const vector<char> &closed, double from, double to, vector<double> &offset) {
    const Steady *response = steady(closed);
    if (!response) return false;
    Piece piece{plm::monodromy(model_, {{to - from, closed}}), at(*response, from), at(*response, to)};
    for (std::int64_t j = 0; j < 2 * n_; ++j) offset[j] -= piece.before[j];
    offset = applied(piece.propagator, offset);
    for (std::int64_t j = 0; j < 2 * n_; ++j) offset[j] += piece.after[j];
    monodromy_ = monodromy_.rows() == 0 ? piece.propagator : product('N', 'N', piece.propagator, monodromy_);
    pieces_.push_back(std::move(piece));
    return true;
}

void EventMotion::look_at_event(const vector<double> &state, const ContactEvent &event,
                                const vector<char> &closed) {
    vector<double> u(model_.n_pairs()), du(model_.n_pairs());
    gemv('N', 1.0, model_.gap(), state.data(), 0.0, u.data());
    gemv('N', 1.0, model_.gap(), state.data() + n_, 0.0, du.data());
    for (std::size_t p = 0; p < u.size(); ++p) {
        u[p] -= model_.initial_gap()[p];
        largest_ = std::max(largest_, std::abs(u[p]));
        if (static_cast<std::int64_t>(p) != event.pair) worst_ = std::max(worst_, closed[p] ? -u[p] : u[p]);
    }
    const std::size_t p = static_cast<std::size_t>(event.pair);
    shifts_.push_back(-u[p] / du[p]);
    shift_ = std::max(shift_, std::abs(shifts_.back()) * omega_);
}

bool EventMotion::solve(const EventSequence &sequence) {
    pieces_.clear();
    shifts_.clear();
    monodromy_ = Matrix();
    size_ = shift_ = largest_ = worst_ = 0;
    vector<char> closed = sequence.closed_first;
    vector<double> offset(2 * n_, 0.0);
    double time = 0;
    for (const ContactEvent &event : sequence.events) {
        if (!add_piece(closed, time, event.time, offset)) return false;
        closed[static_cast<std::size_t>(event.pair)] ^= 1;
        time = event.time;
    }
    if (!add_piece(closed, time, period_, offset)) return false;
    const FlowState zero{vector<double>(n_, 0.0), vector<double>(n_, 0.0), 0};
    PeriodRun run;
    run.end = plm::moved(model_, zero, offset, 1);
    const vector<double> first = period_step(model_, zero, run, monodromy_, within_);
    if (!is_finite(first)) return false;
    start_ = plm::moved(model_, zero, first, 1);
    vector<double> state = first;
    closed = sequence.closed_first;
    const EnergyNorm norm(model_, omega_);
    for (std::size_t k = 0; k < sequence.events.size(); ++k) {
        for (std::int64_t j = 0; j < 2 * n_; ++j) state[j] -= pieces_[k].before[j];
        state = applied(pieces_[k].propagator, state);
        for (std::int64_t j = 0; j < 2 * n_; ++j) state[j] += pieces_[k].after[j];
        look_at_event(state, sequence.events[k], closed);
        closed[static_cast<std::size_t>(sequence.events[k].pair)] ^= 1;
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
        next.closed_first[static_cast<std::size_t>(event.pair)] ^= 1;
    }
    std::stable_sort(next.events.begin(), next.events.end(),
                     [](const ContactEvent &a, const ContactEvent &b) { return a.time < b.time; });
    return next;
}

} // namespace plm
