#include "transient/contact_set.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

ContactSet::ContactSet(const FlowModel &model)
    : model_(model), stiffness_(model.size(), model.size()), square_(model.size(), model.size()),
      gap_force_(model.size()) {
    if (model_.has_diagonal_damping()) {
        for (double c : model_.damping_diagonal()) damping_bound_ = std::max(damping_bound_, std::abs(c));
    } else {
        damping_bound_ = spectral_bound(model_.damping());
    }
}

// |S|_2 <= |S^2|_F^(1/2), at most n^(1/4) too large; scaled, so that nothing overflows.
double ContactSet::spectral_bound(const Matrix &s) {
    double largest = 0;
    for (std::int64_t k = 0; k < s.rows() * s.cols(); ++k) largest = std::max(largest, std::abs(s.data()[k]));
    if (!(largest > 0)) return 0;
    gemm('T', 'N', 1 / largest, s, s, 0.0, square_);
    return std::sqrt(largest * norm2(square_.rows() * square_.cols(), square_.data()));
}

void ContactSet::assign(const vector<char> &closed) {
    if (assigned_ && closed == closed_) return;
    closed_ = closed;
    assigned_ = true;
    const std::int64_t n = model_.size(), z = model_.n_pairs();
    const Matrix &gap = model_.gap();
    const std::int64_t n_closed =
        z - static_cast<std::int64_t>(std::count(closed.begin(), closed.end(), char(0)));
    rows_.reset(n_closed, n); // sqrt(k_n) G_A
    std::fill(gap_force_.begin(), gap_force_.end(), 0.0);
    std::int64_t row = 0;
    for (std::int64_t i = 0; i < z; ++i) {
        if (!closed[i]) continue;
        const double root = std::sqrt(model_.contact_stiffness()[i]);
        const double push = model_.contact_stiffness()[i] * model_.initial_gap()[i];
        for (std::int64_t j = 0; j < n; ++j) {
            rows_(row, j) = root * gap(i, j);
            gap_force_[j] += push * gap(i, j);
        }
        ++row;
    }
    stiffness_.reset(n, n);
    if (n_closed > 0) gemm('T', 'N', 1.0, rows_, rows_, 0.0, stiffness_);
    for (std::int64_t j = 0; j < n; ++j) stiffness_(j, j) += model_.lambda()[j];
    rate_ = std::sqrt(spectral_bound(stiffness_)) + damping_bound_;
}

std::int64_t taylor_terms(double x, double tolerance) {
    double term = 1;
    for (std::int64_t m = 1; m < 200; ++m) {
        const double k = static_cast<double>(m);
        term *= x / k; // x^m / m!
        if (x < k + 1 && term <= tolerance * (1 - x / (k + 1))) return std::max<std::int64_t>(m, 4);
    }
    return 200;
}

} // namespace plm
