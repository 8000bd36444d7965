#include "structure/eigs_block.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace plm {
void LanczosBlock::orthonormalize(const TallMatrix &m, const Field &v, const vector<double> &before) {
    constexpr double enough = 1e-2; // a tenth of the norm: what stays of V is ten roundings
    constexpr int most_passes = 12; // each frees a column of the others at least
    taken_.reset(v.cols(), width());
    rest_ = identity(width());
    origin_ = before;
    for (int pass = 0; pass < most_passes && width() > 0; ++pass) {
        project(m, v);
        if (pass == 0)
            for (std::int64_t j = 0; j < width(); ++j) origin_[j] += entered_[j];
        drop_noise();
        factor_gram();
        divide_by_factor();
        if (std::all_of(left_.begin(), left_.end(), [](double part) { return part > enough; })) return;
    }
    keep_where(left_, enough);
}

/// Takes from X what lies in V; then the Gram matrix of what is left.
void LanczosBlock::project(const TallMatrix &m, const Field &v) {
    mx = m.times(x);
    Matrix overlap(v.cols(), width());
    if (v.cols() > 0) {
        overlap = block_gram(v, mx);
        add_combination(-1, v, overlap, x);
        gemm('N', 'N', 1, overlap, rest_, 1, taken_);
        mx = m.times(x);
    }
    gram_ = block_gram(x, mx);
    order_.resize(width());
    std::iota(order_.begin(), order_.end(), 0);
    entered_.assign(width(), 0.0);
    for (std::int64_t j = 0; j < width(); ++j)
        entered_[j] = std::max(0.0, gram_(j, j)) + dot(v.cols(), overlap.col(j), overlap.col(j));
}

/// Drops what adds no more than rounding to any of the columns there were.
void LanczosBlock::drop_noise() {
    constexpr double eps = std::numeric_limits<double>::epsilon();
    vector<double> share(width(), 0.0);
    for (std::int64_t j = 0; j < rest_.cols(); ++j)
        for (std::int64_t i = 0; i < width() && origin_[j] > 0; ++i)
            share[i] = std::max(share[i], gram_(i, i) * (rest_(i, j) * rest_(i, j) / origin_[j]));
    keep_where(share, eps * eps);
}

/// Cholesky's factor in place of the Gram matrix, the column with most of it left first. Columns that the
/// ones before them contain to five digits are left for the next pass, which sees what remains of them.
void LanczosBlock::factor_gram() {
    constexpr double resolved = 1e-10;
    const std::int64_t n = width();
    vector<double> size(n);
    for (std::int64_t j = 0; j < n; ++j) size[j] = gram_(j, j);
    left_.assign(n, 0.0);
    std::int64_t k = 0;
    for (; k < n; ++k) {
        const auto part = [&](std::int64_t j) { return gram_(j, j) / size[j]; };
        std::int64_t next = k;
        for (std::int64_t j = k + 1; j < n; ++j)
            if (part(j) > part(next)) next = j;
        if (!(part(next) > resolved)) break;
        swap_columns(k, next);
        std::swap(size[k], size[next]);
        left_[k] = gram_(k, k) / entered_[k];
        const double pivot = std::sqrt(gram_(k, k));
        for (std::int64_t j = k; j < n; ++j) gram_(k, j) /= pivot;
        for (std::int64_t j = k + 1; j < n; ++j)
            for (std::int64_t i = k + 1; i < n; ++i) gram_(i, j) -= gram_(k, i) * gram_(k, j);
    }
    for (; k < n; ++k) {
        for (std::int64_t j = k; j < n; ++j) gram_(k, j) = 0;
        gram_(k, k) = 1;
    }
}

/// X U^-1 for X and U rest for the rest, with the factor U.
void LanczosBlock::divide_by_factor() {
    if (x.empty()) return;
    put_in_order();
    x.divide('U', false, gram_);
    mx.divide('U', false, gram_);
    for (std::int64_t j = 0; j < width(); ++j) {
        for (std::int64_t i = j + 1; i < width(); ++i) gram_(i, j) = 0; // what was below the factor
    }
    rest_ = product('N', 'N', gram_, rest_);
}

void LanczosBlock::swap_columns(std::int64_t a, std::int64_t b) {
    if (a == b) return;
    std::swap(order_[a], order_[b]);
    std::swap_ranges(gram_.col(a), gram_.col(a + 1), gram_.col(b));
    for (Matrix *row : {&gram_, &rest_})
        for (std::int64_t j = 0; j < row->cols(); ++j) std::swap((*row)(a, j), (*row)(b, j));
    std::swap(entered_[a], entered_[b]);
}

/// The columns themselves, as the small matrices have them.
void LanczosBlock::put_in_order() {
    if (static_cast<std::int64_t>(order_.size()) == width() && std::is_sorted(order_.begin(), order_.end()))
        return;
    x = x.columns(order_);
    mx = mx.columns(order_);
    std::iota(order_.begin(), order_.end(), 0);
}

/// Drops the columns whose value is not above the limit.
void LanczosBlock::keep_where(const vector<double> &value, double above) {
    const std::int64_t before = width();
    std::int64_t kept = 0;
    for (std::int64_t j = 0; j < before; ++j)
        if (value[j] > above) swap_columns(kept++, j);
    if (kept == before) return;
    Matrix gram(kept, kept), rest(kept, rest_.cols());
    for (std::int64_t i = 0; i < kept; ++i) {
        for (std::int64_t j = 0; j < kept; ++j) gram(i, j) = gram_(i, j);
        for (std::int64_t j = 0; j < rest.cols(); ++j) rest(i, j) = rest_(i, j);
    }
    order_.resize(static_cast<std::size_t>(kept));
    put_in_order();
    gram_ = std::move(gram);
    rest_ = std::move(rest);
}

} // namespace plm
