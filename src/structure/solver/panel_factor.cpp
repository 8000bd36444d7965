#include "structure/solver/panel_factor.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/parallel.hpp"
#include "linalg/work.hpp"
#include "structure/solver/factor.hpp"
#include <algorithm>
#include <type_traits>

namespace plm {
namespace {

/// Columns of a panel that are solved for at once, and rows below them that go through one product.
constexpr std::int64_t panel_strip = 256, panel_band = 512;

/// A subtree has at most this share of all entries: several for each of some threads. Fixed: the order of
/// sums, and with it the digits, hangs on it.
constexpr double largest_share = 1.0 / 16;

/// B = op(L)^-1 B, L unit lower triangular: of one right-hand side, and of several.
void solve_one(char op, blas_int n, const float *l, blas_int ld, float *b) {
    const blas_int step = 1;
    strsv_("L", &op, "U", &n, l, &ld, b, &step, 1, 1, 1);
}
void solve_one(char op, blas_int n, const double *l, blas_int ld, double *b) {
    const blas_int step = 1;
    dtrsv_("L", &op, "U", &n, l, &ld, b, &step, 1, 1, 1);
}
void solve_some(char op, blas_int n, blas_int nrhs, const float *l, blas_int ld, float *b, blas_int ldb) {
    const float one = 1;
    strsm_("L", "L", &op, "U", &n, &nrhs, &one, l, &ld, b, &ldb, 1, 1, 1, 1);
}
void solve_some(char op, blas_int n, blas_int nrhs, const double *l, blas_int ld, double *b, blas_int ldb) {
    const double one = 1;
    dtrsm_("L", "L", &op, "U", &n, &nrhs, &one, l, &ld, b, &ldb, 1, 1, 1, 1);
}

/// One right-hand side alone reads L without packing it.
template <class T>
void triangular_solve(char op, std::int64_t n, std::int64_t nrhs, const T *l, std::int64_t ld, T *b,
                      std::int64_t ldb) {
    if (nrhs == 1)
        solve_one(op, to_blas(n), l, leading(ld), b);
    else
        solve_some(op, to_blas(n), to_blas(nrhs), l, leading(ld), b, leading(ldb));
}

/// C = alpha op(A) B + beta C, op(A) m x k: the same.
template <class T>
void multiply_panel(char op, std::int64_t m, std::int64_t nrhs, std::int64_t k, T alpha, const T *a,
                    std::int64_t lda, const T *b, std::int64_t ldb, T beta, T *c, std::int64_t ldc) {
    if (nrhs == 1)
        gemv(op, op == 'N' ? m : k, op == 'N' ? k : m, alpha, a, lda, b, beta, c);
    else
        gemm(op, m, nrhs, k, alpha, a, lda, b, ldb, beta, c, ldc);
}

double flops_of_product(std::int64_t m, std::int64_t n, std::int64_t k) {
    return 2.0 * static_cast<double>(m * n) * static_cast<double>(k);
}

} // namespace

template <class T>
PanelFactor<T>::PanelFactor(const SparseMatrix &a, const Supernodes &s)
    : n_(a.cols), first_column_(s.first_column, s.first_column + s.count + 1),
      first_row_(s.first_row, s.first_row + s.count + 1), row_(s.row, s.row + s.first_row[s.count]),
      original_(s.original, s.original + n_), first_entry_(s.count + 1, 0), pivots_(n_) {
    allocate_panels();
    choose_subtrees();
    // rounded numbers are of use only where the pivots have digits
    const double least_pivot = std::is_same<T, float>::value ? pivot_noise : 0;
    try {
        eliminate_fronts(a, nodes(), this, least_pivot);
    } catch (const Error &e) {
        if (e.status() == PLM_ERR_SINGULAR) throw_not_positive_definite(e.index());
        throw;
    }
    const auto range = std::minmax_element(pivots_.begin(), pivots_.end());
    largest_pivot_ = *range.second;
    reciprocal_condition_ = *range.first / largest_pivot_;
}

template <class T> void PanelFactor<T>::allocate_panels() {
    const Supernodes all = nodes();
    for (std::int64_t node = 0; node < all.count; ++node) {
        const std::int64_t rows = all.rows_of(node), columns = all.columns_of(node);
        first_entry_[node + 1] = first_entry_[node] + rows * columns;
        most_below_ = std::max(most_below_, rows - columns);
        nonzeros_ += rows * columns - columns * (columns - 1) / 2;
    }
    panels_.resize(first_entry_[all.count]);
}

template <class T> vector<std::int64_t> PanelFactor<T>::parents() const {
    const Supernodes all = nodes();
    vector<std::int64_t> node_of(n_), parent(all.count, all.count);
    for (std::int64_t node = 0; node < all.count; ++node)
        for (std::int64_t j = first_column_[node]; j < first_column_[node + 1]; ++j) node_of[j] = node;
    for (std::int64_t node = 0; node < all.count; ++node)
        if (below(node) > 0) parent[node] = node_of[rows_below(node)[0]];
    return parent;
}

/// The largest subtrees of no more than their share.
template <class T> void PanelFactor<T>::choose_subtrees() {
    const std::int64_t count = nodes().count;
    const vector<std::int64_t> parent = parents();
    vector<std::int64_t> entries(count + 1, 0), first(count + 1, count); // of each subtree
    for (std::int64_t node = 0; node < count; ++node) {
        entries[node] += first_entry_[node + 1] - first_entry_[node];
        first[node] = std::min(first[node], node);
        entries[parent[node]] += entries[node];
        first[parent[node]] = std::min(first[parent[node]], first[node]);
    }
    const double most = largest_share * static_cast<double>(first_entry_[count]);
    const auto fits = [&](std::int64_t node) { return static_cast<double>(entries[node]) <= most; };
    inside_.assign(count, 0);
    first_place_.assign(count, 0);
    for (std::int64_t node = 0; node < count; ++node) {
        inside_[node] = below(node);
        if (!fits(node)) rest_.push_back(node);
        if (!fits(node) || (parent[node] < count && fits(parent[node]))) continue;
        subtrees_.push_back({first[node], node});
        locate_outside_rows(subtrees_.back());
    }
}

/// All rows that a subtree reaches above it are among those below its root.
template <class T> void PanelFactor<T>::locate_outside_rows(const Subtree &subtree) {
    const std::int64_t end = first_column_[subtree.last + 1];
    const std::int64_t *above = rows_below(subtree.last);
    for (std::int64_t node = subtree.first; node <= subtree.last; ++node) {
        const std::int64_t *row = rows_below(node), *const last = row + below(node),
                           *outside = std::lower_bound(row, last, end);
        inside_[node] = outside - row;
        first_place_[node] = static_cast<std::int64_t>(place_.size());
        for (const std::int64_t *place = above; outside < last; ++outside) {
            while (*place < *outside) ++place;
            place_.push_back(place - above);
        }
    }
}

template <> double *PanelFactor<double>::room(std::int64_t node) {
    return panels_.data() + first_entry_[node];
}
template <> double *PanelFactor<float>::room(std::int64_t) {
    return nullptr; // rounded when it is done
}

template <class T> void PanelFactor<T>::take(std::int64_t node, const double *panel, const double *pivots) {
    const std::int64_t first = first_column_[node], columns = nodes().columns_of(node);
    for (std::int64_t k = 0; k < columns; ++k) {
        if (!(pivots[k] > 0)) throw_not_positive_definite(original_[first + k]);
        pivots_[first + k] = pivots[k];
    }
    if (panel == room(node)) return;
    const std::int64_t entries = first_entry_[node + 1] - first_entry_[node];
    T *to = panels_.data() + first_entry_[node];
    for (std::int64_t i = 0; i < entries; ++i) to[i] = static_cast<T>(panel[i]);
}

template <class T> void PanelFactor<T>::solve(double *x, std::int64_t nrhs, std::int64_t ldx) const {
    require(nrhs <= widest_solve, "PanelFactor::solve: too many right-hand sides");
    // then the largest entry of a right-hand side, and the largest pivot, become one, whatever the units are
    constexpr bool rounded = std::is_same<T, float>::value;
    const double scale_of_pivots = rounded ? largest_pivot_ : 1;
    vector<T> entries(n_ * nrhs); // in the new order
    vector<double> size(nrhs, 1.0);
    const double work = 10 * static_cast<double>(n_ * nrhs); // it takes as long as so many flops
    parallel_for(nrhs, work, [&](std::int64_t j) {
        const double *column = x + j * ldx;
        if (rounded) {
            size[j] = 0;
            for (std::int64_t i = 0; i < n_; ++i) size[j] = std::max(size[j], std::fabs(column[i]));
        }
        const double scale = size[j] > 0 ? 1 / size[j] : 0;
        T *to = entries.data() + j * n_;
        for (std::int64_t i = 0; i < n_; ++i) to[i] = static_cast<T>(column[original_[i]] * scale);
    });
    solve_in_order({entries.data(), n_, 0, nullptr}, nrhs, scale_of_pivots);
    parallel_for(nrhs, work, [&](std::int64_t j) {
        const T *from = entries.data() + j * n_;
        for (std::int64_t i = 0; i < n_; ++i) x[original_[i] + j * ldx] = from[i] * size[j] / scale_of_pivots;
    });
    worked(4.0 * static_cast<double>(nonzeros_) * static_cast<double>(nrhs));
}

template <class T>
void PanelFactor<T>::solve_in_order(const Rows &x, std::int64_t nrhs, double scale_of_pivots) const {
    const auto count = static_cast<std::int64_t>(subtrees_.size());
    const double flops = flops_of_product(nonzeros_, nrhs, 1);
    std::vector<vector<T>> from_subtrees(subtrees_.size());
    parallel_for(count, flops, [&](std::int64_t k) {
        forward_subtree(subtrees_[k], x, nrhs, from_subtrees[static_cast<std::size_t>(k)]);
    });
    forward_rest(from_subtrees, x, nrhs);
    parallel_for(nrhs, 10 * static_cast<double>(n_ * nrhs), [&](std::int64_t j) {
        divide(0, n_, {x.entries + j * x.ld, x.ld, 0, nullptr}, 1, scale_of_pivots);
    });
    backward_rest(x, nrhs);
    parallel_for(count, flops, [&](std::int64_t k) { backward_subtree(subtrees_[k], x, x, nrhs); });
}

/// By the pivots, of some columns of L.
template <class T>
void PanelFactor<T>::divide(std::int64_t first, std::int64_t last, const Rows &x, std::int64_t nrhs,
                            double scale) const {
    for (std::int64_t j = 0; j < nrhs; ++j) {
        T *column = x.at(first) + j * x.ld;
        for (std::int64_t i = first; i < last; ++i)
            column[i - first] = static_cast<T>(column[i - first] * (scale / pivots_[i]));
    }
}

template <class T> std::int64_t PanelFactor<T>::most_below(const Subtree &subtree) const {
    std::int64_t most = 0;
    for (std::int64_t node = subtree.first; node <= subtree.last; ++node) most = std::max(most, below(node));
    return most;
}

/// above: what it adds to the rows below its root.
template <class T>
void PanelFactor<T>::forward_subtree(const Subtree &subtree, const Rows &x, std::int64_t nrhs,
                                     vector<T> &above) const {
    const std::int64_t reached = below(subtree.last);
    above.assign(reached * nrhs, 0);
    vector<T> sums(most_below(subtree) * nrhs);
    for (std::int64_t node = subtree.first; node <= subtree.last; ++node) {
        forward_own(node, x, nrhs, sums.data());
        const std::int64_t *row = rows_below(node), *place = place_.data() + first_place_[node];
        const std::int64_t inside = inside_[node], outside = below(node) - inside;
        for (std::int64_t j = 0; j < nrhs; ++j) {
            const T *sum = sums.data() + j * below(node);
            for (std::int64_t i = 0; i < inside; ++i) x.at(row[i])[j * x.ld] -= sum[i];
            for (std::int64_t i = 0; i < outside; ++i) above[place[i] + j * reached] += sum[inside + i];
        }
    }
}

/// The supernodes above the subtrees; from_subtrees: empty where one adds nothing.
template <class T>
void PanelFactor<T>::forward_rest(const std::vector<vector<T>> &from_subtrees, const Rows &x,
                                  std::int64_t nrhs) const {
    const auto subtract = [&](std::int64_t node, const T *sums) {
        const std::int64_t *row = rows_below(node);
        for (std::int64_t j = 0; j < nrhs; ++j)
            for (std::int64_t i = 0; i < below(node); ++i)
                x.at(row[i])[j * x.ld] -= sums[i + j * below(node)];
    };
    for (std::size_t k = 0; k < subtrees_.size(); ++k)
        if (!from_subtrees[k].empty()) subtract(subtrees_[k].last, from_subtrees[k].data());
    vector<T> sums(most_below_ * nrhs);
    for (std::int64_t node : rest_) {
        forward_own(node, x, nrhs, sums.data());
        subtract(node, sums.data());
    }
}

/// The columns of a supernode, and `sums`, below x nrhs: what is to be subtracted below them.
template <class T>
void PanelFactor<T>::forward_own(std::int64_t node, const Rows &x, std::int64_t nrhs, T *sums) const {
    const std::int64_t rows = nodes().rows_of(node), columns = nodes().columns_of(node);
    const std::int64_t staying = rows - columns, bands = (staying + panel_band - 1) / panel_band;
    const T *panel = panels_.data() + first_entry_[node];
    T *own = x.at(first_column_[node]);
    for (std::int64_t first = 0; first < columns; first += panel_strip) {
        const std::int64_t width = std::min(panel_strip, columns - first), last = first + width;
        const T *l = panel + first * rows;
        triangular_solve('N', width, nrhs, l + first, rows, own + first, x.ld);
        parallel_for(1 + bands, flops_of_product(rows - last, nrhs, width), [&](std::int64_t k) {
            if (k == 0 && last < columns)
                multiply_panel<T>('N', columns - last, nrhs, width, -1, l + last, rows, own + first, x.ld, 1,
                                  own + last, x.ld);
            if (k == 0) return;
            const std::int64_t begin = (k - 1) * panel_band, height = std::min(panel_band, staying - begin);
            multiply_panel<T>('N', height, nrhs, width, 1, l + columns + begin, rows, own + first, x.ld,
                              first > 0, sums + begin, staying);
        });
    }
}

template <class T> void PanelFactor<T>::backward_rest(const Rows &x, std::int64_t nrhs) const {
    vector<T> known(most_below_ * nrhs);
    for (auto node = rest_.rbegin(); node != rest_.rend(); ++node)
        backward_node(*node, x, x, nrhs, known.data());
}

template <class T>
void PanelFactor<T>::backward_subtree(const Subtree &subtree, const Rows &x, const KnownRows &above,
                                      std::int64_t nrhs) const {
    vector<T> known(most_below(subtree) * nrhs);
    for (std::int64_t node = subtree.last; node >= subtree.first; --node)
        backward_node(node, x, above, nrhs, known.data());
}

/// above: rows above the subtree; known: room for below x nrhs.
template <class T>
void PanelFactor<T>::backward_node(std::int64_t node, const Rows &x, const KnownRows &above,
                                   std::int64_t nrhs, T *known) const {
    const std::int64_t rows = nodes().rows_of(node), columns = nodes().columns_of(node);
    const std::int64_t staying = rows - columns, strips = (columns + panel_strip - 1) / panel_strip;
    const std::int64_t *row = rows_below(node);
    const T *panel = panels_.data() + first_entry_[node];
    T *own = x.at(first_column_[node]);
    for (std::int64_t j = 0; j < nrhs; ++j) {
        T *column = known + j * staying;
        for (std::int64_t i = 0; i < inside_[node]; ++i) column[i] = x.at(row[i])[j * x.ld];
        for (std::int64_t i = inside_[node]; i < staying; ++i) column[i] = above.at(row[i])[j * above.ld];
    }
    const auto subtract = [&](std::int64_t s, std::int64_t first_row, std::int64_t height, const T *from,
                              std::int64_t ld) {
        const std::int64_t first = s * panel_strip, width = std::min(panel_strip, columns - first);
        multiply_panel<T>('T', width, nrhs, height, -1, panel + first_row + first * rows, rows, from, ld, 1,
                          own + first, x.ld);
    };
    if (staying > 0)
        parallel_for(strips, flops_of_product(staying, nrhs, columns),
                     [&](std::int64_t s) { subtract(s, columns, staying, known, staying); });
    for (std::int64_t s = strips - 1; s >= 0; --s) {
        const std::int64_t first = s * panel_strip, width = std::min(panel_strip, columns - first);
        triangular_solve('T', width, nrhs, panel + first + first * rows, rows, own + first, x.ld);
        parallel_for(s, flops_of_product(first, nrhs, width),
                     [&](std::int64_t earlier) { subtract(earlier, first, width, own + first, x.ld); });
    }
}

template class PanelFactor<float>;
template class PanelFactor<double>;

} // namespace plm
