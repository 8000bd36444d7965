#include "contact/piece_penetrations.hpp"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace plm {

void PiecePenetrations::expand(const vector<double> &at_begin, const vector<double> &travel,
                               const Matrix &gap_by_pair, char op, const Matrix &powers,
                               const Matrix &aside) {
    const std::int64_t n = gap_by_pair.rows(), z = gap_by_pair.cols();
    at_begin_ = at_begin;
    near_.clear();
    for (std::int64_t i = 0; i < z; ++i)
        if (!(std::abs(at_begin[i]) > travel[i])) near_.push_back(i);
    const bool most = 4 * static_cast<std::int64_t>(near_.size()) > 3 * z; // not worth being put together
    if (most) {
        all_are_near(z);
    } else {
        rows_.reset(n, static_cast<std::int64_t>(near_.size()));
        for (std::int64_t c = 0; c < rows_.cols(); ++c)
            std::copy_n(gap_by_pair.col(near_[c]), n, rows_.col(c));
    }
    const Matrix &rows = most ? gap_by_pair : rows_;
    powers_.reset(op == 'T' ? powers.cols() : powers.rows(), rows.cols());
    if (near_.empty()) return;
    gemm(op, 'N', 1.0, powers, rows, 0.0, powers_);
    for (std::int64_t c = 0; c < powers_.cols(); ++c)
        for (std::int64_t k = 0; k < aside.cols(); ++k) powers_(k, c) += aside(near_[c], k);
}

void PiecePenetrations::expand(const Matrix &powers) {
    powers_ = powers;
    at_begin_.resize(static_cast<std::size_t>(powers.cols()));
    for (std::int64_t i = 0; i < powers.cols(); ++i) at_begin_[i] = powers(0, i);
    all_are_near(powers.cols());
}

void PiecePenetrations::all_are_near(std::int64_t n_pairs) {
    near_.resize(static_cast<std::size_t>(n_pairs));
    std::iota(near_.begin(), near_.end(), std::int64_t(0));
}

void PiecePenetrations::draw_near(const vector<double> &by) {
    for (std::size_t c = 0; c < near_.size(); ++c) {
        double &begin = powers_.col(static_cast<std::int64_t>(c))[0];
        if (by[near_[c]] > 0) begin -= std::copysign(by[near_[c]], begin);
    }
}

} // namespace plm
