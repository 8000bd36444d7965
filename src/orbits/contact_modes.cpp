#include "orbits/contact_modes.hpp"
#include "linalg/work.hpp"
#include "orbits/contact_set.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double worst_condition = 1e-8; // reciprocal, of the eigenvectors: digits lost on the way to and fro
constexpr double free_rate = 1e-10;      // of the fastest: nothing brings such a motion back
constexpr std::int64_t worth_it = 40;    // pieces: as much work as the eigenvectors
constexpr double most_bytes = 1.5e8, most_entries = 4096;

} // namespace

ContactModes::ContactModes(const FlowModel &model, const PairStates &states) : n_(model.size()) {
    ContactSet set(model);
    set.assign(states);
    decompose(model, set.stiffness());
    if (!usable_) return;
    constant_ = load_in_coordinates(model.constant_load(model.contact().springs(states)));
    for (const auto &[harmonic, load] : model.excitation())
        loads_.push_back({harmonic, load_in_coordinates(load.real),
                          load.imag.empty() ? vector<double>(2 * n_, 0.0) : load_in_coordinates(load.imag)});
}

void ContactModes::decompose(const FlowModel &model, const Matrix &k) {
    const std::int64_t n = n_, size = 2 * n;
    root_.resize(n);
    for (std::int64_t j = 0; j < n; ++j) root_[j] = k(j, j) > 0 ? std::sqrt(k(j, j)) : 1.0;
    Matrix a(size, size);
    for (std::int64_t j = 0; j < n; ++j) {
        a(j, n + j) = root_[j];
        for (std::int64_t i = 0; i < n; ++i) {
            a(n + i, j) = -k(i, j) / root_[j];
            if (!model.has_diagonal_damping()) a(n + i, n + j) = -model.damping()(i, j);
        }
        if (model.has_diagonal_damping()) a(n + j, n + j) = -model.damping_diagonal()[j];
    }
    worked(25.0 * static_cast<double>(size * size * size));
    const GeneralEigen eigen = general_eigen(a);
    Matrix w(size, size), inverse(size, size);
    double fastest = 0, slowest = INFINITY;
    for (std::int64_t j = 0; j < size; ++j) {
        const std::complex<double> rate = eigen.values[j], *v = eigen.vectors.data() + j * size;
        fastest = std::max(fastest, std::abs(rate)), slowest = std::min(slowest, std::abs(rate));
        const bool pair = rate.imag() != 0;
        modes_.push_back({rate, j, pair, std::abs(rate)});
        for (std::int64_t i = 0; i < size; ++i) {
            w(i, j) = v[i].real();
            if (pair) w(i, j + 1) = -v[i].imag();
        }
        if (pair) ++j;
    }
    if (!(slowest > free_rate * fastest)) return;
    RealLu lu;
    Matrix copy = w;
    lu.factor(copy);
    if (lu.singular() || !(lu.reciprocal_condition() > worst_condition)) return;
    for (std::int64_t j = 0; j < size; ++j) inverse(j, j) = 1;
    lu.solve(inverse.data(), size, size);
    usable_ = true;
    displacement_.reset(n, size);
    for (std::int64_t j = 0; j < size; ++j)
        for (std::int64_t i = 0; i < n; ++i) displacement_(i, j) = w(i, j) / root_[i];
    gap_ = model.n_pairs() > 0 ? product('N', 'N', model.gap(), displacement_) : Matrix(0, size);
    reach_.reset(gap_.rows(), static_cast<std::int64_t>(modes_.size()));
    for (std::int64_t k = 0; k < reach_.cols(); ++k) {
        const Mode &m = modes_[static_cast<std::size_t>(k)];
        for (std::int64_t i = 0; i < reach_.rows(); ++i)
            reach_(i, k) =
                m.is_pair ? std::hypot(gap_(i, m.first), gap_(i, m.first + 1)) : std::abs(gap_(i, m.first));
    }
    to_state_ = std::move(w);
    from_state_ = std::move(inverse);
}

vector<double> ContactModes::load_in_coordinates(const vector<double> &force) const {
    vector<double> c(2 * n_, 0.0);
    for (std::int64_t j = 0; j < n_; ++j)
        for (std::int64_t i = 0; i < 2 * n_; ++i) c[i] += from_state_(i, n_ + j) * force[j];
    return c;
}

void ContactModes::to_state(const double *c, double *y, double *v) const {
    vector<double> x(2 * n_);
    gemv('N', 1.0, to_state_, c, 0.0, x.data());
    for (std::int64_t j = 0; j < n_; ++j) y[j] = x[j] / root_[j], v[j] = x[n_ + j];
}

void ContactModes::from_state(const double *y, const double *v, double *c) const {
    vector<double> x(2 * n_);
    for (std::int64_t j = 0; j < n_; ++j) x[j] = y[j] * root_[j], x[n_ + j] = v[j];
    gemv('N', 1.0, from_state_, x.data(), 0.0, c);
}

void ContactModes::advance(double dt, Matrix &m, Matrix &scratch) const {
    for (std::int64_t j = 0; j < m.cols(); ++j)
        for (std::int64_t i = 0; i < n_; ++i) m(i, j) *= root_[i];
    scratch.reset(m.rows(), m.cols());
    gemm('N', 'N', 1.0, from_state_, m, 0.0, scratch);
    for (const Mode &mode : modes_) {
        const std::complex<double> factor = std::exp(mode.rate * dt);
        for (std::int64_t j = 0; j < m.cols(); ++j) {
            double *c = scratch.col(j) + mode.first;
            if (mode.is_pair) {
                const std::complex<double> z = factor * std::complex<double>(c[0], c[1]);
                c[0] = z.real(), c[1] = z.imag();
            } else {
                c[0] *= factor.real();
            }
        }
    }
    gemm('N', 'N', 1.0, to_state_, scratch, 0.0, m);
    for (std::int64_t j = 0; j < m.cols(); ++j)
        for (std::int64_t i = 0; i < n_; ++i) m(i, j) /= root_[i];
    worked(8 * static_cast<double>(n_ * n_ * m.cols()));
}

double ContactModes::bytes() const {
    return 8.0 * static_cast<double>(2 * to_state_.rows() * to_state_.cols() +
                                     displacement_.rows() * displacement_.cols() + gap_.rows() * gap_.cols() +
                                     reach_.rows() * reach_.cols());
}

const ContactModes *ContactModesKept::find(const PairStates &states, std::int64_t effort) {
    Entry &entry = entries_[states];
    entry.last_use = ++clock_;
    entry.effort += effort;
    if (entry.tried) return entry.modes && entry.modes->usable() ? entry.modes.get() : nullptr;
    if (entry.effort < worth_it) return nullptr;
    entry.tried = true;
    auto modes = std::make_unique<ContactModes>(*model_, states);
    if (!modes->usable()) return nullptr;
    make_room(modes->bytes());
    Entry &now = entries_[states]; // room may have been made by dropping all others
    now.tried = true;
    now.last_use = clock_;
    now.modes = std::move(modes);
    bytes_ += now.modes->bytes();
    return now.modes.get();
}

// The sets not seen for the longest time go, half of them at once.
void ContactModesKept::make_room(double bytes) {
    if (bytes_ + bytes < most_bytes && static_cast<double>(entries_.size()) < most_entries) return;
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
