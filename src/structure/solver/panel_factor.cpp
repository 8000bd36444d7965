#include "structure/solver/panel_factor.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/work.hpp"
#include "structure/solver/factor.hpp"
#include <algorithm>

namespace plm {
namespace {

/// B = op(L)^-1 B, L unit lower triangular.
void triangular_solve(char op, std::int64_t n, std::int64_t nrhs, const float *l, std::int64_t ld, float *b,
                      std::int64_t ldb) {
    const blas_int rows = to_blas(n), cols = to_blas(nrhs), ld_l = leading(ld), ld_b = leading(ldb);
    const float one = 1;
    strsm_("L", "L", &op, "U", &rows, &cols, &one, l, &ld_l, b, &ld_b, 1, 1, 1, 1);
}

} // namespace

PanelFactor::PanelFactor(const SparseMatrix &a, const Supernodes &s)
    : n_(a.cols), first_column_(s.first_column, s.first_column + s.count + 1),
      first_row_(s.first_row, s.first_row + s.count + 1), row_(s.row, s.row + s.first_row[s.count]),
      original_(s.original, s.original + n_), first_entry_(s.count), pivots_(n_) {
    std::int64_t entries = 0, most_below = 0;
    for (std::int64_t node = 0; node < s.count; ++node) {
        const std::int64_t rows = s.rows_of(node), columns = s.columns_of(node);
        first_entry_[node] = entries;
        entries += rows * columns;
        most_below = std::max(most_below, rows - columns);
        nonzeros_ += rows * columns - columns * (columns - 1) / 2;
    }
    panels_.resize(entries);
    rows_below_.resize(most_below * widest_solve);
    try {
        eliminate_fronts(a, nodes(), this);
    } catch (const Error &e) {
        if (e.status() == PLM_ERR_SINGULAR) throw_not_positive_definite(e.index());
        throw;
    }
    const auto range = std::minmax_element(pivots_.begin(), pivots_.end());
    largest_pivot_ = *range.second;
    reciprocal_condition_ = *range.first / largest_pivot_;
}

void PanelFactor::take(std::int64_t node, const double *panel, const double *pivots) {
    const std::int64_t first = first_column_[node], columns = nodes().columns_of(node);
    for (std::int64_t k = 0; k < columns; ++k) {
        if (!(pivots[k] > 0)) throw_not_positive_definite(original_[first + k]);
        pivots_[first + k] = pivots[k];
    }
    const std::int64_t entries = nodes().rows_of(node) * columns;
    float *to = panels_.data() + first_entry_[node];
    for (std::int64_t i = 0; i < entries; ++i) to[i] = static_cast<float>(panel[i]);
}

void PanelFactor::solve(double *x, std::int64_t nrhs) const {
    require(nrhs <= widest_solve, "PanelFactor::solve: too many right-hand sides");
    work_.resize(n_ * nrhs);
    double
        size[widest_solve]; // of each right-hand side: the largest entry becomes one, whatever the units are
    for (std::int64_t j = 0; j < nrhs; ++j) {
        const double *column = x + j * n_;
        size[j] = 0;
        for (std::int64_t i = 0; i < n_; ++i) size[j] = std::max(size[j], std::fabs(column[i]));
        const double scale = size[j] > 0 ? 1 / size[j] : 0;
        for (std::int64_t i = 0; i < n_; ++i)
            work_[i + j * n_] = static_cast<float>(column[original_[i]] * scale);
    }
    forward(nrhs);
    divide_by_pivots(nrhs);
    backward(nrhs);
    for (std::int64_t j = 0; j < nrhs; ++j)
        for (std::int64_t i = 0; i < n_; ++i)
            x[original_[i] + j * n_] = work_[i + j * n_] * size[j] / largest_pivot_;
    worked(4.0 * static_cast<double>(nonzeros_) * static_cast<double>(nrhs));
}

void PanelFactor::divide_by_pivots(std::int64_t nrhs) const {
    for (std::int64_t j = 0; j < nrhs; ++j)
        for (std::int64_t i = 0; i < n_; ++i)
            work_[i + j * n_] = static_cast<float>(work_[i + j * n_] * (largest_pivot_ / pivots_[i]));
}

void PanelFactor::forward(std::int64_t nrhs) const {
    const Supernodes all = nodes();
    for (std::int64_t node = 0; node < all.count; ++node) {
        const std::int64_t rows = all.rows_of(node), columns = all.columns_of(node), below = rows - columns;
        const float *panel = panels_.data() + first_entry_[node];
        float *own = work_.data() + first_column_[node], *sums = rows_below_.data();
        triangular_solve('N', columns, nrhs, panel, rows, own, n_);
        if (below == 0) continue;
        gemm('N', below, nrhs, columns, 1, panel + columns, rows, own, n_, 0, sums, below);
        const std::int64_t *row = row_.data() + first_row_[node] + columns;
        for (std::int64_t j = 0; j < nrhs; ++j)
            for (std::int64_t i = 0; i < below; ++i) work_[row[i] + j * n_] -= sums[i + j * below];
    }
}

void PanelFactor::backward(std::int64_t nrhs) const {
    const Supernodes all = nodes();
    for (std::int64_t node = all.count - 1; node >= 0; --node) {
        const std::int64_t rows = all.rows_of(node), columns = all.columns_of(node), below = rows - columns;
        const float *panel = panels_.data() + first_entry_[node];
        float *own = work_.data() + first_column_[node], *known = rows_below_.data();
        if (below > 0) {
            const std::int64_t *row = row_.data() + first_row_[node] + columns;
            for (std::int64_t j = 0; j < nrhs; ++j)
                for (std::int64_t i = 0; i < below; ++i) known[i + j * below] = work_[row[i] + j * n_];
            gemm('T', columns, nrhs, below, -1, panel + columns, rows, known, below, 1, own, n_);
        }
        triangular_solve('T', columns, nrhs, panel, rows, own, n_);
    }
}

} // namespace plm
