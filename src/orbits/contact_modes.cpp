#include "orbits/contact_modes.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double worst_condition = 1e-8; // reciprocal, of the eigenvectors: digits lost on the way to and fro
constexpr double no_rate = 1e-10;        // of the fastest: by which nothing can be divided
// Of the fastest: free motions. Rounding makes so much of rates 0 whose eigenvectors coincide.
constexpr double free_rate = 1e-6;
// Pieces that are as much work as the eigenvectors, n^3 against n^2: some at least, and by the coordinate.
constexpr std::int64_t worth_it = 120, worth_a_coordinate = 2;
constexpr double most_bytes = 1.5e8, most_transition_bytes = 1e8, most_entries = 4096;

} // namespace

ContactModes::ContactModes(const FlowModel &model, const PairStates &states)
    : set_(model), moving_(model.n_moving()), massive_(model.n_massive()) {
    set_.assign(states);
    decompose(system_matrix(model, set_.stiffness()));
    if (!usable_) return;
    find_displacements(model);
    const vector<double> none(static_cast<std::size_t>(model.size()), 0.0);
    constant_ = load_of(model, model.preload(), model.initial_gap());
    for (const auto &[part, load] : model.excitation()) {
        vector<double> real, imag;
        for (const std::complex<double> &g : model.gap_motion(part))
            real.push_back(g.real()), imag.push_back(g.imag());
        loads_.push_back({part, load_of(model, load.real, real),
                          load_of(model, load.imag.empty() ? none : load.imag, imag)});
    }
}

// c y' = -K y - C v where there is no mass; its y' acts through the damping on what has mass, too.
Matrix ContactModes::system_matrix(const FlowModel &model, const Matrix &k) {
    const std::int64_t n = moving_, size = moving_ + massive_;
    const bool diagonal = model.has_diagonal_damping();
    root_.resize(n);
    double largest = 0;
    for (std::int64_t j = 0; j < n; ++j) largest = std::max(largest, k(j, j));
    for (std::int64_t j = 0; j < n; ++j) // what rounding leaves of a free motion's stiffness is no scale
        root_[j] = k(j, j) > no_rate * no_rate * largest ? std::sqrt(k(j, j)) : 1.0;
    Matrix a(size, size);
    for (std::int64_t j = 0; j < massive_; ++j) {
        a(j, n + j) = root_[j];
        for (std::int64_t i = 0; i < massive_ && !diagonal; ++i) a(n + i, n + j) = -model.damping()(i, j);
        if (diagonal) a(n + j, n + j) = -model.damping_diagonal()[j];
    }
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < massive_; ++i) a(n + i, j) = -k(i, j) / root_[j];
    for (std::int64_t r = massive_; r < n; ++r) {
        const double c = model.own_damping(r);
        for (std::int64_t j = 0; j < n; ++j) a(r, j) = -root_[r] * k(r, j) / (root_[j] * c);
        for (std::int64_t j = 0; j < massive_ && !diagonal; ++j)
            a(r, n + j) = -root_[r] * model.damping()(r, j) / c;
        for (std::int64_t j = 0; j < size && !diagonal; ++j)
            for (std::int64_t i = 0; i < massive_; ++i)
                a(n + i, j) -= model.damping()(i, r) * a(r, j) / root_[r];
    }
    return a;
}

void ContactModes::decompose(const Matrix &system) {
    const auto size = static_cast<double>(system.rows());
    worked(25.0 * size * size * size);
    const GeneralEigen eigen = general_eigen(system);
    if (take(eigen, nullptr)) return;
    const double radius = free_rate * std::abs(eigen.values[0]);
    for (const std::complex<double> &rate : eigen.values)
        if (std::abs(rate) < radius) free_speed_ = std::max(free_speed_, std::abs(rate));
    const SplitSpectrum split = split_spectrum(system, radius);
    if (split.slow.cols() > 0) take(general_eigen(split.rest_block), &split);
}

// The eigenvectors, of all motions or of what the split leaves beside the free ones. False: no digits are
// left to them.
bool ContactModes::take(const GeneralEigen &eigen, const SplitSpectrum *split) {
    const auto n = static_cast<std::int64_t>(eigen.values.size());
    modes_.clear();
    Matrix w(n, n);
    for (std::int64_t j = 0; j < n; ++j) {
        const std::complex<double> rate = eigen.values[j], *v = eigen.vectors.data() + j * n;
        const bool pair = rate.imag() != 0;
        modes_.push_back({rate, j, pair, std::abs(rate)});
        for (std::int64_t i = 0; i < n; ++i) {
            w(i, j) = v[i].real();
            if (pair) w(i, j + 1) = -v[i].imag();
        }
        if (pair) ++j;
    }
    if (n == 0 || !(modes_.back().speed > no_rate * modes_.front().speed)) return false;
    if (split) {
        const Matrix rest = product('N', 'N', split->rest, w);
        free_ = split->slow_block;
        w.reset(rest.rows(), rest.rows());
        std::copy_n(rest.data(), rest.rows() * n, w.data());
        std::copy_n(split->slow.data(), w.rows() * free_.rows(), w.col(n));
    }
    RealLu lu;
    Matrix copy = w, inverse(w.rows(), w.rows());
    lu.factor(copy);
    if (lu.singular()) return false;
    condition_ = lu.reciprocal_condition();
    if (!(condition_ > worst_condition)) return false;
    for (std::int64_t j = 0; j < w.rows(); ++j) inverse(j, j) = 1;
    lu.solve(inverse.data(), w.rows(), w.rows());
    usable_ = true;
    to_state_ = std::move(w);
    from_state_ = std::move(inverse);
    return true;
}

void ContactModes::find_displacements(const FlowModel &model) {
    displacement_.reset(model.size(), size());
    for (std::int64_t j = 0; j < size(); ++j)
        for (std::int64_t i = 0; i < moving_; ++i) displacement_(i, j) = to_state_(i, j) / root_[i];
    Matrix gap(model.n_pairs(), size());
    if (model.n_pairs() > 0) gemm('N', 'N', 1.0, model.gap(), displacement_, 0.0, gap);
    if (model.n_following() > 0 && model.n_pairs() > 0) {
        Matrix force;
        set_.add_contact(gap, force);
        for (std::int64_t j = 0; j < size(); ++j)
            for (std::int64_t i = moving_; i < model.size(); ++i)
                displacement_(i, j) =
                    -dot(model.n_pairs(), model.gap().col(i), force.col(j)) / model.lambda()[i];
    }
    gap_by_pair_ = gap.transposed();
    for (std::int64_t i = 0; i < gap.rows(); ++i) gap_size_.push_back(norm2(size(), gap_by_pair_.col(i)));
    reach_.reset(gap.rows(), static_cast<std::int64_t>(modes_.size()));
    for (std::int64_t k = 0; k < reach_.cols(); ++k) {
        const Mode &m = modes_[static_cast<std::size_t>(k)];
        for (std::int64_t i = 0; i < reach_.rows(); ++i)
            reach_(i, k) =
                m.is_pair ? std::hypot(gap(i, m.first), gap(i, m.first + 1)) : std::abs(gap(i, m.first));
    }
}

// What follows is put aside at once, which the contact answers; both act on what moves.
ContactModes::Load ContactModes::load_of(const FlowModel &model, const vector<double> &force,
                                         const vector<double> &gap) const {
    const std::int64_t z = model.n_pairs();
    vector<double> f(force), aside(force.size(), 0.0);
    Matrix u(z, 1), contact;
    if (z > 0) {
        for (std::int64_t j = moving_; j < model.size(); ++j) aside[j] = f[j] / model.lambda()[j];
        gemv('N', 1.0, model.gap(), aside.data(), 0.0, u.data());
        for (std::int64_t i = 0; i < z; ++i) u(i, 0) -= gap[i];
        set_.add_contact(u, contact);
        gemv('T', -1.0, model.gap(), contact.data(), 1.0, f.data());
    }
    vector<double> state(static_cast<std::size_t>(size()), 0.0), following;
    for (std::int64_t j = 0; j < massive_; ++j) state[moving_ + j] = f[j];
    for (std::int64_t r = massive_; r < moving_; ++r) {
        const double rate = f[r] / model.own_damping(r);
        state[r] = root_[r] * rate;
        for (std::int64_t j = 0; j < massive_ && !model.has_diagonal_damping(); ++j)
            state[moving_ + j] -= model.damping()(j, r) * rate;
    }
    for (std::int64_t j = moving_; j < model.size(); ++j) following.push_back(f[j] / model.lambda()[j]);
    Load load{vector<double>(state.size()), vector<double>(u.data(), u.data() + z), std::move(following)};
    gemv('N', 1.0, from_state_, state.data(), 0.0, load.coordinates.data());
    return load;
}

void ContactModes::to_state(const double *c, double *y, double *v) const {
    vector<double> x(static_cast<std::size_t>(size()));
    gemv('N', 1.0, to_state_, c, 0.0, x.data());
    for (std::int64_t j = 0; j < moving_; ++j) y[j] = x[j] / root_[j];
    for (std::int64_t j = 0; j < massive_; ++j) v[j] = x[moving_ + j];
}

void ContactModes::from_state(const double *y, const double *v, double *c) const {
    vector<double> x(static_cast<std::size_t>(size()));
    for (std::int64_t j = 0; j < moving_; ++j) x[j] = y[j] * root_[j];
    for (std::int64_t j = 0; j < massive_; ++j) x[moving_ + j] = v[j];
    gemv('N', 1.0, from_state_, x.data(), 0.0, c);
}

void ContactModes::enter(Matrix &m) const {
    for (std::int64_t j = 0; j < m.cols(); ++j)
        for (std::int64_t i = 0; i < moving_; ++i) m(i, j) *= root_[i];
    m = product('N', 'N', from_state_, m);
    worked(static_cast<double>(size() * size() * m.cols()));
}

namespace {

// exp(S dt) of so little that its series ends after some powers.
Matrix small_exponential(const Matrix &s, double dt) {
    constexpr int most_powers = 60;
    const std::int64_t k = s.rows();
    Matrix sum(k, k), power(k, k), next(k, k);
    for (std::int64_t i = 0; i < k; ++i) sum(i, i) = power(i, i) = 1;
    for (int j = 1; j < most_powers && norm2(k * k, power.data()) > 1e-17 * norm2(k * k, sum.data()); ++j) {
        gemm('N', 'N', dt / j, s, power, 0.0, next);
        std::swap(power, next);
        for (std::int64_t i = 0; i < k * k; ++i) sum.data()[i] += power.data()[i];
    }
    return sum;
}

} // namespace

template <class Real> void ContactModes::turn(double dt, vector<Real> &coordinates) const {
    vector<std::complex<Real>> factors;
    const Matrix free = small_exponential(free_, dt);
    vector<Real> before(static_cast<std::size_t>(free_.rows()));
    for (const Mode &mode : modes_) factors.push_back(std::complex<Real>(std::exp(mode.rate * dt)));
    const auto n = static_cast<std::size_t>(size());
    for (std::size_t first = 0; first < coordinates.size(); first += n) {
        Real *c = coordinates.data() + first;
        for (std::size_t k = 0; k < modes_.size(); ++k) {
            const Real re = factors[k].real(), im = factors[k].imag(), real = c[0];
            c[0] *= re;
            if (modes_[k].is_pair) {
                c[0] -= im * c[1];
                c[1] = re * c[1] + im * real;
                ++c;
            }
            ++c;
        }
        std::copy_n(c, free_.rows(), before.data());
        for (std::int64_t i = 0; i < free_.rows(); ++i) {
            c[i] = 0;
            for (std::int64_t j = 0; j < free_.rows(); ++j)
                c[i] += static_cast<Real>(free(i, j)) * before[static_cast<std::size_t>(j)];
        }
    }
}
template void ContactModes::turn(double, vector<double> &) const;
template void ContactModes::turn(double, vector<float> &) const;

void ContactModes::leave(Matrix &coordinates) const {
    coordinates = product('N', 'N', to_state_, coordinates);
    for (std::int64_t j = 0; j < coordinates.cols(); ++j)
        for (std::int64_t i = 0; i < moving_; ++i) coordinates(i, j) /= root_[i];
    worked(static_cast<double>(size() * size() * coordinates.cols()));
}

void ContactModes::enter_row(vector<double> &row) const {
    vector<double> scaled = row;
    for (std::int64_t i = 0; i < moving_; ++i) scaled[i] /= root_[i];
    gemv('T', 1.0, to_state_, scaled.data(), 0.0, row.data());
}

void ContactModes::leave_row(vector<double> &row) const {
    const vector<double> of_coordinates = row;
    gemv('T', 1.0, from_state_, of_coordinates.data(), 0.0, row.data());
    for (std::int64_t i = 0; i < moving_; ++i) row[i] *= root_[i];
}

Matrix ContactModes::transition(const ContactModes &to) const {
    Matrix state = to_state_;
    for (std::int64_t j = 0; j < state.cols(); ++j)
        for (std::int64_t i = 0; i < moving_; ++i) state(i, j) *= to.root_[i] / root_[i];
    worked(static_cast<double>(size() * size() * size()));
    return product('N', 'N', to.from_state_, state);
}

double ContactModes::bytes() const {
    return 8.0 *
           static_cast<double>(2 * to_state_.rows() * to_state_.cols() + 3 * moving_ * moving_ +
                               displacement_.rows() * displacement_.cols() +
                               gap_by_pair_.rows() * gap_by_pair_.cols() + reach_.rows() * reach_.cols());
}

std::shared_ptr<const ContactModes> ContactModesKept::known(const PairStates &states) const {
    const auto found = entries_.find(states);
    return found != entries_.end() ? found->second.modes : nullptr;
}

std::shared_ptr<const ContactModes> ContactModesKept::find(const PairStates &states, std::int64_t effort) {
    Entry &entry = entries_[states];
    entry.last_use = ++clock_;
    entry.effort += effort;
    if (entry.tried) return entry.modes;
    if (entry.effort < std::max(worth_it, worth_a_coordinate * model_->n_moving())) return nullptr;
    entry.tried = true;
    auto modes = std::make_shared<const ContactModes>(*model_, states);
    if (!modes->usable()) return nullptr;
    make_room(modes->bytes());
    Entry &now = entries_[states]; // room may have been made by dropping all others
    now.tried = true;
    now.last_use = clock_;
    now.modes = std::move(modes);
    bytes_ += now.modes->bytes();
    return now.modes;
}

template <> std::map<ContactModesKept::Way, vector<double>> &ContactModesKept::transitions() {
    return transitions_;
}
template <> std::map<ContactModesKept::Way, vector<float>> &ContactModesKept::transitions() {
    return single_transitions_;
}

template <class Real>
const vector<Real> &ContactModesKept::transition(const std::shared_ptr<const ContactModes> &from,
                                                 const std::shared_ptr<const ContactModes> &to) {
    auto &kept = transitions<Real>();
    const auto found = kept.find({from, to});
    if (found != kept.end()) return found->second;
    const double bytes = sizeof(Real) * static_cast<double>(to->size() * to->size());
    if (bytes * static_cast<double>(kept.size() + 1) > most_transition_bytes) kept.clear();
    const Matrix way = from->transition(*to);
    return kept[{from, to}] = vector<Real>(way.data(), way.data() + way.rows() * way.cols());
}
template const vector<double> &ContactModesKept::transition(const std::shared_ptr<const ContactModes> &,
                                                            const std::shared_ptr<const ContactModes> &);
template const vector<float> &ContactModesKept::transition(const std::shared_ptr<const ContactModes> &,
                                                           const std::shared_ptr<const ContactModes> &);

const vector<double> *
ContactModesKept::known_transition(const std::shared_ptr<const ContactModes> &from,
                                   const std::shared_ptr<const ContactModes> &to) const {
    const auto found = transitions_.find({from, to});
    return found != transitions_.end() ? &found->second : nullptr;
}

void ContactModesKept::forget_transitions() {
    transitions_.clear();
    single_transitions_.clear();
}

std::vector<PairStates> ContactModesKept::settle() {
    std::vector<std::pair<std::int64_t, Known>> used;
    for (const auto &[states, entry] : entries_)
        if (entry.modes) used.push_back({entry.last_use, {states, entry.modes}});
    std::sort(used.begin(), used.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
    std::vector<Known> known;
    std::vector<PairStates> sets;
    for (auto &[when, one] : used) {
        sets.push_back(one.first);
        known.push_back(std::move(one));
    }
    begin_with(known);
    return sets;
}

// What was worked for them once is not counted again.
void ContactModesKept::take(const std::vector<PairStates> &sets) {
    const WorkCount uncounted;
    std::vector<Known> known;
    for (const PairStates &states : sets) {
        auto modes = std::make_shared<const ContactModes>(*model_, states);
        if (modes->usable()) known.emplace_back(states, std::move(modes));
    }
    begin_with(known);
}

void ContactModesKept::begin_with(const std::vector<Known> &known) {
    forget_transitions();
    entries_.clear();
    bytes_ = 0;
    clock_ = 0;
    for (const auto &[states, modes] : known) {
        Entry &entry = entries_[states];
        entry.last_use = ++clock_;
        entry.tried = true;
        entry.modes = modes;
        bytes_ += modes->bytes();
    }
}

// The sets not seen for the longest time go, half of them at once.
void ContactModesKept::make_room(double bytes) {
    if (bytes_ + bytes < most_bytes && static_cast<double>(entries_.size()) < most_entries) return;
    forget_transitions(); // they hold what is to go
    vector<std::int64_t> uses;
    for (const auto &[states, entry] : entries_) uses.push_back(entry.last_use);
    std::nth_element(uses.begin(), uses.begin() + static_cast<std::ptrdiff_t>(uses.size() / 2), uses.end());
    const std::int64_t oldest = uses[uses.size() / 2];
    for (auto it = entries_.begin(); it != entries_.end();) {
        if (it->second.last_use >= oldest) {
            ++it;
            continue;
        }
        if (it->second.modes) bytes_ -= it->second.modes->bytes();
        it = entries_.erase(it);
    }
}

} // namespace plm
