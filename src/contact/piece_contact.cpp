#include "contact/piece_contact.hpp"
#include "linalg/error.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t n_groups = 16;          // of pairs; a power of two
constexpr std::int64_t widest_in_groups = 256; // the sums of wider ones would fill 16 MB and more

} // namespace

PieceContact::PieceContact(const Contact &contact, const Matrix &gap, const Matrix &flexibility,
                           std::int64_t n_moving)
    : contact_(contact), gap_(gap), flexibility_(flexibility), moving_(n_moving), norms_(gap.rows(), 0.0) {
    for (std::int64_t j = 0; j < moving_; ++j)
        for (std::int64_t i = 0; i < gap.rows(); ++i)
            norms_[i] += contact.stiffness[i] * gap(i, j) * gap(i, j);
}

bool PieceContact::assign(const PairStates &states, Matrix &stiffness) {
    if (assigned_ && states == states_) return false;
    const bool changes = assigned_; // a set that stays needs no sums
    assigned_ = false;
    active_ = states.closed_pairs();
    if (changes && flexibility_.empty() && moving_ <= widest_in_groups) {
        sum_springs(states, stiffness);
    } else {
        sums_.clear();
        find_stiffness(stiffness);
    }
    states_ = states;
    return assigned_ = true;
}

// Along a motion one pair or two change at a time, and the sums of the other groups stay.
void PieceContact::sum_springs(const PairStates &states, Matrix &stiffness) {
    const std::int64_t z = states.size(), per_group = (z + n_groups - 1) / n_groups;
    if (z == 0) return;
    const bool anew = sums_.empty();
    if (anew) {
        sprung_ = gap_.transposed();
        for (std::int64_t i = 0; i < z; ++i)
            for (std::int64_t j = 0; j < moving_; ++j) sprung_(j, i) *= std::sqrt(contact_.stiffness[i]);
        sums_.assign(2 * n_groups, Matrix(moving_, moving_));
    }
    changed_.assign(2 * n_groups, 0);
    for (std::int64_t i = 0; i < z; ++i)
        if (anew || states.is_closed(i) != states_.is_closed(i)) changed_[n_groups + i / per_group] = 1;
    for (std::int64_t node = 2 * n_groups - 1; node > 0; --node) {
        if (!changed_[node]) continue;
        changed_[node / 2] = 1;
        if (node >= n_groups) {
            sum_group(node - n_groups, states);
            continue;
        }
        const double *a = sums_[2 * node].data(), *b = sums_[2 * node + 1].data();
        double *c = sums_[node].data();
        for (std::int64_t k = 0; k < moving_ * moving_; ++k) c[k] = a[k] + b[k];
    }
    stiffness = sums_[1];
}

void PieceContact::sum_group(std::int64_t group, const PairStates &states) {
    const std::int64_t z = states.size(), per_group = (z + n_groups - 1) / n_groups,
                       first = group * per_group;
    std::int64_t n = 0;
    rows_.reset(moving_, per_group);
    for (std::int64_t i = first; i < std::min(first + per_group, z); ++i)
        if (states.is_closed(i)) std::copy_n(sprung_.col(i), moving_, rows_.col(n++));
    rows_.cut(n);
    if (n > 0)
        gemm('N', 'T', 1.0, rows_, rows_, 0.0, sums_[n_groups + group]);
    else
        sums_[n_groups + group].reset(moving_, moving_);
}

// Symmetric to the last bit where S is diagonal.
void PieceContact::find_stiffness(Matrix &stiffness) {
    const std::int64_t n = static_cast<std::int64_t>(active_.size());
    rows_.reset(n, moving_);
    for (std::int64_t j = 0; j < moving_; ++j)
        for (std::int64_t row = 0; row < n; ++row) rows_(row, j) = gap_(active_[row], j);
    stiffness.reset(moving_, moving_);
    if (n == 0) return;
    const vector<double> &k = contact_.stiffness;
    if (flexibility_.empty()) {
        for (std::int64_t row = 0; row < n; ++row) {
            const double root = std::sqrt(k[active_[row]]);
            for (std::int64_t j = 0; j < moving_; ++j) rows_(row, j) *= root;
        }
        gemm('T', 'N', 1.0, rows_, rows_, 0.0, stiffness);
        return;
    }
    Matrix t(n, n);
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < n; ++i)
            t(i, j) = flexibility_(active_[i], active_[j]) + (i == j ? 1 / k[active_[i]] : 0.0);
    if (!cholesky_.factor(t))
        throw Error(status::singular,
                    "the flexibility of the closed pairs is not positive definite; look for "
                    "gap rows of very different size")
            .reason(reason::singular);
    Matrix force = rows_;
    cholesky_.solve(force.data(), moving_, n);
    gemm('T', 'N', 1.0, rows_, force, 0.0, stiffness);
    for (std::int64_t j = 0; j < moving_; ++j)
        for (std::int64_t i = j + 1; i < moving_; ++i)
            stiffness(i, j) = stiffness(j, i) = 0.5 * (stiffness(i, j) + stiffness(j, i));
}

double PieceContact::growth_since(const PairStates &other) const {
    double sum = 0;
    for (std::int64_t i : active_)
        if (!other.is_closed(i)) sum += norms_[i];
    return sum;
}

void PieceContact::add_forces(Matrix &u, Matrix &force) const {
    force.reset(u.rows(), u.cols());
    if (active_.empty()) return;
    const std::int64_t n = static_cast<std::int64_t>(active_.size());
    const vector<double> &k = contact_.stiffness;
    if (flexibility_.empty()) {
        for (std::int64_t c = 0; c < u.cols(); ++c)
            for (std::int64_t i : active_) force(i, c) = k[i] * u(i, c);
        return;
    }
    Matrix acting(n, u.cols());
    for (std::int64_t c = 0; c < u.cols(); ++c)
        for (std::int64_t a = 0; a < n; ++a) acting(a, c) = u(active_[a], c);
    cholesky_.solve(acting.data(), u.cols(), n);
    for (std::int64_t c = 0; c < u.cols(); ++c)
        for (std::int64_t a = 0; a < n; ++a) force(active_[a], c) = acting(a, c);
    gemm('N', 'N', -1.0, flexibility_, force, 1.0, u);
    for (std::int64_t c = 0; c < u.cols(); ++c)
        for (std::int64_t i : active_) u(i, c) = force(i, c) / k[i];
}

} // namespace plm
