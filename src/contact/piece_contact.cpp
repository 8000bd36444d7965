#include "contact/piece_contact.hpp"
#include "linalg/error.hpp"
#include <cmath>

namespace plm {

bool PieceContact::assign(const PairStates &states, Matrix &stiffness) {
    if (assigned_ && states == states_) return false;
    assigned_ = false;
    states_ = states;
    active_ = states.closed_pairs();
    find_stiffness(stiffness);
    return assigned_ = true;
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
        for (std::int64_t j = 0; j < moving_; ++j)
            for (std::int64_t row = 0; row < n; ++row) rows_(row, j) *= std::sqrt(k[active_[row]]);
        gemm('T', 'N', 1.0, rows_, rows_, 0.0, stiffness);
        return;
    }
    Matrix t(n, n);
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < n; ++i)
            t(i, j) = flexibility_(active_[i], active_[j]) + (i == j ? 1 / k[active_[i]] : 0.0);
    if (!cholesky_.factor(t))
        throw Error(PLM_ERR_SINGULAR,
                    "the flexibility of the closed pairs is not positive definite; look for "
                    "gap rows of very different size")
            .reason(PLM_REASON_SINGULAR);
    Matrix force = rows_;
    cholesky_.solve(force.data(), moving_, n);
    gemm('T', 'N', 1.0, rows_, force, 0.0, stiffness);
    for (std::int64_t j = 0; j < moving_; ++j)
        for (std::int64_t i = j + 1; i < moving_; ++i)
            stiffness(i, j) = stiffness(j, i) = 0.5 * (stiffness(i, j) + stiffness(j, i));
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
