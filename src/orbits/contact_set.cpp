#include "orbits/contact_set.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

namespace {

// Rows and columns [0, n) or, for the last ones, [n, size).
Matrix square_block(const Matrix &a, std::int64_t first, std::int64_t end) {
    Matrix b(end - first, end - first);
    for (std::int64_t j = first; j < end; ++j)
        for (std::int64_t i = first; i < end; ++i) b(i - first, j - first) = a(i, j);
    return b;
}

} // namespace

ContactSet::ContactSet(const FlowModel &model)
    : model_(model), moving_(model.n_moving()), massive_(model.n_massive()),
      contact_(model.contact(), model.gap(), model.flexibility(), moving_), stiffness_(moving_, moving_) {
    if (model_.has_diagonal_damping()) {
        for (std::int64_t j = 0; j < massive_; ++j)
            damping_bound_ = std::max(damping_bound_, std::abs(model_.damping_diagonal()[j]));
    } else {
        damping_bound_ = spectral_bound(square_block(model_.damping(), 0, massive_));
    }
}

// |S|_2 <= |(S^T S)^2|_F^(1/4), at most n^(1/8) too large; scaled, so that nothing overflows.
double ContactSet::spectral_bound(const Matrix &s) {
    double largest = 0;
    for (std::int64_t k = 0; k < s.rows() * s.cols(); ++k) largest = std::max(largest, std::abs(s.data()[k]));
    if (!(largest > 0)) return 0;
    square_.reset(s.cols(), s.cols());
    gemm('T', 'N', 1 / largest, s, s, 0.0, square_);
    fourth_.reset(s.cols(), s.cols());
    gemm('N', 'N', 1 / largest, square_, square_, 0.0, fourth_);
    return largest * std::sqrt(std::sqrt(norm2(fourth_.rows() * fourth_.cols(), fourth_.data()) / largest));
}

void ContactSet::assign(const PairStates &states) {
    if (!contact_.assign(states, stiffness_)) return;
    for (std::int64_t j = 0; j < moving_; ++j) stiffness_(j, j) += model_.lambda()[j];
    relaxing_ = stiffness_.columns(massive_, moving_ - massive_);
    if (!raise_rate()) find_rate(states);
}

// |K_i| grows by no more than the springs that act now and did not where it was bounded, and those that act
// no more leave the bound as it is. False: it might be too large for its purpose.
bool ContactSet::raise_rate() {
    constexpr int oldest = 32;
    constexpr double loosest = 1.2;
    if (model_.n_following() > 0 || bounded_.empty() || ++age_ > oldest) return false;
    const double bound = bound_ + contact_.growth_since(bounded_);
    if (bound > loosest * bound_) return false;
    rate_ = std::sqrt(bound) + damping_bound_;
    return true;
}

// What relaxes adds the fastest of its time constants, and what couples it with the rest, which is no faster
// than both together.
void ContactSet::find_rate(const PairStates &states) {
    if (moving_ == massive_) {
        bound_ = spectral_bound(stiffness_);
        rate_ = std::sqrt(bound_) + damping_bound_;
        bounded_ = states;
        age_ = 0;
        return;
    }
    Matrix relaxing = square_block(stiffness_, massive_, moving_);
    for (std::int64_t j = 0; j < relaxing.cols(); ++j)
        for (std::int64_t i = 0; i < relaxing.rows(); ++i)
            relaxing(i, j) /= std::sqrt(model_.own_damping(massive_ + i) * model_.own_damping(massive_ + j));
    const double oscillating = std::sqrt(spectral_bound(square_block(stiffness_, 0, massive_)));
    rate_ = 2 * (oscillating + damping_bound_ + spectral_bound(relaxing));
}

// c k y_k = dt (f - K y)_(k-1) - k C y_k of what has mass.
void ContactSet::relax(std::int64_t k, double dt, const double *before, const double *force,
                       double *next) const {
    const double step = dt / static_cast<double>(k);
    for (std::int64_t j = massive_; j < moving_; ++j) {
        double f = force ? force[j] : 0.0;
        f = step * (f - dot(moving_, relaxing_.col(j - massive_), before));
        if (!model_.has_diagonal_damping()) f -= dot(massive_, model_.damping().col(j), next);
        next[j] = f / model_.own_damping(j);
    }
}

std::int64_t taylor_terms(double x, double tolerance) {
    double term = 1;
    for (std::int64_t m = 1; m < 200; ++m) {
        const double k = static_cast<double>(m);
        term *= x / k; // x^m / m!
        if (x < k + 1 && term <= tolerance * (1 - x / (k + 1))) return m;
    }
    return 200;
}

} // namespace plm
