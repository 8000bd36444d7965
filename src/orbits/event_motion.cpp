#include "orbits/event_motion.hpp"
#include "linalg/lapack.hpp"
#include "linalg/scale.hpp"
#include "orbits/period_map.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using complex = std::complex<double>;

constexpr double longest_move = 0.02; // of the period
constexpr double missed_event = 1e-3; // of the largest penetration or gap, on the wrong side

vector<double> applied(const Matrix &m, const vector<double> &x) {
    vector<double> y(m.rows());
    gemv('N', 1.0, m, x.data(), 0.0, y.data());
    return y;
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
Matrix EventMotion::stiffness_of(const vector<double> &springs) const {
    Matrix rows = model_.gap(), stiffness(n_, n_);
    for (std::int64_t p = 0; p < rows.rows(); ++p) {
        const double root = std::sqrt(springs[p]);
        for (std::int64_t j = 0; j < n_; ++j) rows(p, j) *= root;
    }
    if (rows.rows() > 0) gemm('T', 'N', 1.0, rows, rows, 0.0, stiffness);
    for (std::int64_t j = 0; j < n_; ++j) stiffness(j, j) += model_.lambda()[j];
    return stiffness;
}

vector<complex> EventMotion::wave(const Matrix &stiffness, const LoadPart &part, const HarmonicLoad &load,
                                  const vector<complex> &wall_load) const {
    const double w = part.harmonic * omega_, scale = force_scale_ * part.growth(omega_);
    vector<complex> a(n_ * n_), q(n_);
    for (std::int64_t j = 0; j < n_; ++j) {
        for (std::int64_t i = 0; i < n_; ++i)
            a[i + j * n_] = {stiffness(i, j),
                             model_.has_diagonal_damping() ? 0.0 : w * model_.damping()(i, j)};
        a[j + j * n_] += complex(-w * w * model_.mass(j),
                                 model_.has_diagonal_damping() ? w * model_.damping_diagonal()[j] : 0.0);
        q[j] = scale * (complex(load.real[j], load.imag[j]) + wall_load[j]);
    }
    ComplexLu lu;
    lu.factor(n_, a);
    lu.solve(q.data(), 1, n_);
    return q;
}

// What moving walls do through the springs of a contact set, G^T k g of one part.
vector<complex> EventMotion::wall_load(const vector<double> &springs, const LoadPart &part) const {
    vector<complex> load(n_, 0.0);
    const vector<complex> gaps = model_.gap_motion(part);
    for (std::int64_t p = 0; p < model_.n_pairs(); ++p) {
        const complex pushed = springs[p] * gaps[p];
        for (std::int64_t j = 0; pushed != 0.0 && j < n_; ++j) load[j] += model_.gap()(p, j) * pushed;
    }
    return load;
}

// What pre-load, mean excitation and the gaps of the pairs do through their springs, then each harmonic.
// Null: the system of this set is singular.
const EventMotion::Steady *EventMotion::steady(const PairStates &states) {
    if (const auto known = known_.find(states); known != known_.end()) return known->second.get();
    const vector<double> springs = model_.contact().springs(states);
    Matrix stiffness = stiffness_of(springs);
    auto found = std::make_shared<Steady>();
    found->mean = model_.constant_load(springs);
    for (const auto &[part, load] : model_.excitation()) {
        const vector<complex> pushed = wall_load(springs, part);
        if (part.harmonic != 0)
            found->waves.emplace_back(part.harmonic * omega_, wave(stiffness, part, load, pushed));
        for (std::int64_t j = 0; part.harmonic == 0 && j < n_; ++j)
            found->mean[j] += force_scale_ * part.growth(omega_) * (load.real[j] + pushed[j].real());
    }
    RealLu lu;
    lu.factor(stiffness);
    if (lu.singular()) return nullptr;
    lu.solve(found->mean.data(), 1, n_);
    return known_.emplace(states, std::move(found)).first->second.get();
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

bool EventMotion::add_piece(const PairStates &states, double from, double to, vector<double> &offset) {
    const Steady *response = steady(states);
    if (!response) return false;
    pieces_.push_back(
        {plm::monodromy(model_, {{to - from, states}}), at(*response, from), at(*response, to)});
    const Matrix &propagator = pieces_.back().propagator;
    pass(pieces_.back(), offset);
    monodromy_ = monodromy_.rows() == 0 ? propagator : product('N', 'N', propagator, monodromy_);
    return true;
}

// Penetrations (first column) and their rates: of the steady response, and of the free motion beside it, in
// which what has no mass is where the rest and the contact put it.
Matrix EventMotion::penetrations(const Whole &steady, const vector<double> &state, const PairStates &states,
                                 double time) {
    const std::int64_t moving = model_.n_moving(), massive = model_.n_massive(), z = model_.n_pairs();
    const vector<double> at_rest = state_of(steady);
    vector<double> y(n_, 0.0), v(n_, 0.0);
    for (std::int64_t j = 0; j < moving; ++j) y[j] = state[j] - at_rest[j];
    for (std::int64_t j = 0; j < massive; ++j) v[j] = state[moving + j] - at_rest[moving + j];
    set_.assign(states);
    set_.relax(1, 1.0, y.data(), nullptr, v.data());
    Matrix u(z, 2), force;
    gemv('N', 1.0, model_.gap(), y.data(), 0.0, u.col(0));
    gemv('N', 1.0, model_.gap(), v.data(), 0.0, u.col(1));
    set_.add_contact(u, force);
    gemv('N', 1.0, model_.gap(), steady.y.data(), 1.0, u.col(0));
    gemv('N', 1.0, model_.gap(), steady.v.data(), 1.0, u.col(1));
    const vector<double> gaps = model_.contact().gaps_at(omega_, time, force_scale_),
                         rates = model_.contact().gap_rates_at(omega_, time, force_scale_);
    for (std::int64_t p = 0; p < z; ++p) {
        u(p, 0) -= gaps[p];
        u(p, 1) -= rates[p];
    }
    return u;
}

void EventMotion::look_at_event(const Matrix &u, const ContactEvent &event, const PairStates &states) {
    for (std::int64_t p = 0; p < u.rows(); ++p) largest_ = std::max(largest_, std::abs(u(p, 0)));
    worst_ = std::max(worst_, wrong_side(states, u.col(0), event.pair));
    shifts_.push_back(-u(event.pair, 0) / u(event.pair, 1));
    shift_ = std::max(shift_, std::abs(shifts_.back()) * omega_);
}

bool EventMotion::solve(const EventSequence &sequence) {
    pieces_.clear();
    shifts_.clear();
    monodromy_ = Matrix();
    size_ = shift_ = largest_ = worst_ = 0;
    PairStates states = sequence.first;
    vector<double> offset(model_.state_size(), 0.0);
    double time = 0;
    for (const ContactEvent &event : sequence.events) {
        if (!add_piece(states, time, event.time, offset)) return false;
        pass_event(states, event);
        time = event.time;
    }
    if (!add_piece(states, time, period_, offset)) return false;
    const FlowState zero{vector<double>(n_, 0.0), vector<double>(n_, 0.0), 0};
    PeriodRun run;
    run.end = plm::moved(model_, zero, offset, 1);
    vector<double> state = period_step(model_, zero, run, monodromy_, within_);
    if (!all_finite(state.data(), static_cast<std::int64_t>(state.size()))) return false;
    start_ = plm::moved(model_, zero, state, 1);
    states = sequence.first;
    const EnergyNorm norm(model_, omega_);
    for (std::size_t k = 0; k < sequence.events.size(); ++k) {
        const ContactEvent &event = sequence.events[k];
        pass(pieces_[k], state);
        look_at_event(penetrations(pieces_[k].after, state, states, event.time), event, states);
        pass_event(states, event);
        size_ = std::max(size_, norm.distance(plm::moved(model_, zero, state, 1), start_));
    }
    consistent_ = worst_ <= missed_event * largest_;
    return std::isfinite(shift_) && std::isfinite(size_);
}

EventSequence EventMotion::moved(const EventSequence &sequence) const {
    vector<double> moves = shifts_;
    for (double &move : moves) move = std::clamp(move, -longest_move * period_, longest_move * period_);
    return sequence.moved(moves, period_);
}

} // namespace plm
