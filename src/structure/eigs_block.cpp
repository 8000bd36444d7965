#include "structure/eigs_block.hpp"
#include "linalg/blas_lapack.hpp"
#include <algorithm>
#include <limits>

namespace plm {
namespace {

Matrix identity(std::int64_t n) {
    Matrix a(n, n);
    for (std::int64_t i = 0; i < n; ++i) a(i, i) = 1;
    return a;
}

} // namespace

void LanczosBlock::orthonormalize(const SparseMatrix &m, const Matrix &v, const vector<double> &before) {
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
void LanczosBlock::project(const SparseMatrix &m, const Matrix &v) {
    mx = multiply_transposed(m, x); // M is symmetric: the gathering form is faster
    Matrix overlap(v.cols(), width());
    if (v.cols() > 0) {
        gemm('T', 'N', 1, v, mx, 0, overlap);
        gemm('N', 'N', -1, v, overlap, 1, x);
        gemm('N', 'N', 1, overlap, rest_, 1, taken_);
        mx = multiply_transposed(m, x);
    }
    gram_ = product('T', 'N', x, mx);
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
    const blas_int rows = to_blas(x.rows()), cols = to_blas(width());
    const double one = 1;
    if (rows == 0 || cols == 0) return;
    for (Matrix *block : {&x, &mx})
        dtrsm_("R", "U", "N", "N", &rows, &cols, &one, gram_.data(), &cols, block->data(), &rows, 1, 1, 1, 1);
    for (std::int64_t j = 0; j < width(); ++j) {
        for (std::int64_t i = j + 1; i < width(); ++i) gram_(i, j) = 0; // what was below the factor
    }
    rest_ = product('N', 'N', gram_, rest_);
}

void LanczosBlock::swap_columns(std::int64_t a, std::int64_t b) {
    if (a == b) return;
    for (Matrix *block : {&x, &mx, &gram_}) std::swap_ranges(block->col(a), block->col(a + 1), block->col(b));
    for (Matrix *row : {&gram_, &rest_})
        for (std::int64_t j = 0; j < row->cols(); ++j) std::swap((*row)(a, j), (*row)(b, j));
    std::swap(entered_[a], entered_[b]);
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
    x.cut(kept);
    mx.cut(kept);
    gram_ = std::move(gram);
    rest_ = std::move(rest);
}

} // namespace plm
