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

template <class T> void add_row(T sign, const T *from, T *to) {
    for (std::int64_t k = 0; k < side_by_side<T>; ++k) to[k] += sign * from[k];
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
        if (e.status() == status::singular) throw_not_positive_definite(e.index());
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
    LaneBlock<T> entries(n_, nrhs); // in the new order
    vector<double> size(nrhs, 1.0);
    const double work = 10 * static_cast<double>(n_ * nrhs); // it takes as long as so many flops
    parallel_for(rounded ? nrhs : 0, work, [&](std::int64_t j) {
        const double *column = x + j * ldx;
        size[j] = 0;
        for (std::int64_t i = 0; i < n_; ++i) size[j] = std::max(size[j], std::fabs(column[i]));
    });
    const auto for_rows = [&](const auto &body) { // body(row of x, entries of the group, its columns)
        parallel_for(entries.groups(), work, [&](std::int64_t g) {
            const std::int64_t first = g * side_by_side<T>, width = std::min(side_by_side<T>, nrhs - first);
            T *row = entries.all().group(g);
            for (std::int64_t i = 0; i < n_; ++i, row += side_by_side<T>)
                for (std::int64_t k = 0; k < width; ++k)
                    body(x[original_[i] + (first + k) * ldx], row[k], size[first + k]);
        });
    };
    for_rows([](double from, T &to, double scale) {
        to = static_cast<T>(!rounded ? from : scale > 0 ? from / scale : 0 * from); // NaN stays
    });
    solve_in_order(entries.all(), scale_of_pivots);
    for_rows([&](double &to, T from, double scale) { to = from * scale / scale_of_pivots; });
    worked(static_cast<double>(nonzeros_) * static_cast<double>(nrhs));
}

template <class T> void PanelFactor<T>::solve_in_order(const LaneRows<T> &all, double scale_of_pivots) const {
    const Rows x{all, 0, nullptr};
    const auto count = static_cast<std::int64_t>(subtrees_.size());
    const double flops = flops_of_product(nonzeros_, all.groups * side_by_side<T>, 1);
    std::vector<LaneBlock<T>> from_subtrees(subtrees_.size());
    parallel_for(count, flops, [&](std::int64_t k) {
        forward_subtree(subtrees_[k], x, from_subtrees[static_cast<std::size_t>(k)]);
    });
    forward_rest(from_subtrees, x);
    parallel_for(all.groups, 10 * static_cast<double>(n_ * side_by_side<T>), [&](std::int64_t g) {
        divide(0, n_, {{all.group(g), all.stride, 1}, 0, nullptr}, scale_of_pivots);
    });
    backward_rest(x);
    parallel_for(count, flops, [&](std::int64_t k) { backward_subtree(subtrees_[k], x, x); });
}

/// By the pivots, of some columns of L.
template <class T>
void PanelFactor<T>::divide(std::int64_t first, std::int64_t last, const Rows &x, double scale) const {
    for (std::int64_t g = 0; g < x.all.groups; ++g) {
        T *row = x.at(first, g);
        for (std::int64_t i = first; i < last; ++i, row += side_by_side<T>)
            for (std::int64_t k = 0; k < side_by_side<T>; ++k)
                row[k] = static_cast<T>(row[k] * (scale / pivots_[i]));
    }
}

template <class T> std::int64_t PanelFactor<T>::most_below(const Subtree &subtree) const {
    std::int64_t most = 0;
    for (std::int64_t node = subtree.first; node <= subtree.last; ++node) most = std::max(most, below(node));
    return most;
}

template <class T>
void PanelFactor<T>::forward_subtree(const Subtree &subtree, const Rows &x, LaneBlock<T> &above) const {
    const std::int64_t groups = x.all.groups, lanes = side_by_side<T>;
    above = LaneBlock<T>(below(subtree.last), groups * lanes);
    LaneBlock<T> sums(most_below(subtree), groups * lanes);
    for (std::int64_t node = subtree.first; node <= subtree.last; ++node) {
        forward_own(node, x, sums.all());
        const std::int64_t *row = rows_below(node), *place = place_.data() + first_place_[node];
        const std::int64_t inside = inside_[node], outside = below(node) - inside;
        for (std::int64_t g = 0; g < groups; ++g) {
            const T *sum = sums.all().group(g);
            T *to = above.all().group(g);
            for (std::int64_t i = 0; i < inside; ++i) add_row<T>(-1, sum + i * lanes, x.at(row[i], g));
            for (std::int64_t i = 0; i < outside; ++i)
                add_row<T>(1, sum + (inside + i) * lanes, to + place[i] * lanes);
        }
    }
}

/// The supernodes above the subtrees.
template <class T>
void PanelFactor<T>::forward_rest(const std::vector<LaneBlock<T>> &from_subtrees, const Rows &x) const {
    const std::int64_t groups = x.all.groups, lanes = side_by_side<T>;
    const auto subtract = [&](std::int64_t node, const LaneRows<const T> &sums) {
        const std::int64_t *row = rows_below(node);
        for (std::int64_t g = 0; g < groups; ++g)
            for (std::int64_t i = 0; i < below(node); ++i)
                add_row<T>(-1, sums.group(g) + i * lanes, x.at(row[i], g));
    };
    for (std::size_t k = 0; k < subtrees_.size(); ++k)
        if (!from_subtrees[k].empty()) subtract(subtrees_[k].last, from_subtrees[k].all());
    LaneBlock<T> sums(most_below_, groups * lanes);
    for (std::int64_t node : rest_) {
        forward_own(node, x, sums.all());
        subtract(node, sums.all());
    }
}

/// The columns of a supernode, and `sums`: what is to be subtracted below them.
template <class T>
void PanelFactor<T>::forward_own(std::int64_t node, const Rows &x, const LaneRows<T> &sums) const {
    const std::int64_t rows = nodes().rows_of(node), columns = nodes().columns_of(node);
    const std::int64_t staying = rows - columns, bands = (staying + panel_band - 1) / panel_band;
    const T *panel = panels_.data() + first_entry_[node];
    const LaneRows<T> own = x.from(first_column_[node]);
    for (std::int64_t first = 0; first < columns; first += panel_strip) {
        const std::int64_t width = std::min(panel_strip, columns - first), last = first + width;
        const T *l = panel + first * rows;
        const LaneRows<T> strip = own.from(first);
        solve_lower(width, l + first, rows, strip);
        const double flops = flops_of_product(rows - last, own.groups * side_by_side<T>, width);
        parallel_for(1 + bands, flops, [&](std::int64_t k) {
            if (k == 0 && last < columns)
                multiply_panel<T>(columns - last, width, l + last, rows, strip, -1, false, own.from(last));
            if (k == 0) return;
            const std::int64_t begin = (k - 1) * panel_band, height = std::min(panel_band, staying - begin);
            multiply_panel<T>(height, width, l + columns + begin, rows, strip, 1, first == 0,
                              sums.from(begin));
        });
    }
}

template <class T> void PanelFactor<T>::backward_rest(const Rows &x) const {
    LaneBlock<T> known(most_below_, x.all.groups * side_by_side<T>);
    for (auto node = rest_.rbegin(); node != rest_.rend(); ++node) backward_node(*node, x, x, known.all());
}

template <class T>
void PanelFactor<T>::backward_subtree(const Subtree &subtree, const Rows &x, const KnownRows &above) const {
    LaneBlock<T> known(most_below(subtree), x.all.groups * side_by_side<T>);
    for (std::int64_t node = subtree.last; node >= subtree.first; --node)
        backward_node(node, x, above, known.all());
}

/// above: rows above the subtree; known: room for those below the supernode.
template <class T>
void PanelFactor<T>::backward_node(std::int64_t node, const Rows &x, const KnownRows &above,
                                   const LaneRows<T> &known) const {
    const std::int64_t rows = nodes().rows_of(node), columns = nodes().columns_of(node);
    const std::int64_t staying = rows - columns, strips = (columns + panel_strip - 1) / panel_strip;
    const std::int64_t *row = rows_below(node);
    const T *panel = panels_.data() + first_entry_[node];
    const LaneRows<T> own = x.from(first_column_[node]);
    for (std::int64_t g = 0; g < own.groups; ++g) {
        T *to = known.group(g);
        for (std::int64_t i = 0; i < staying; ++i, to += side_by_side<T>)
            std::copy_n(i < inside_[node] ? x.at(row[i], g) : above.at(row[i], g), side_by_side<T>, to);
    }
    const auto subtract = [&](std::int64_t s, std::int64_t first_row, std::int64_t height,
                              const LaneRows<const T> &from) {
        const std::int64_t first = s * panel_strip, width = std::min(panel_strip, columns - first);
        subtract_panel_transposed<T>(height, width, panel + first_row + first * rows, rows, from,
                                     own.from(first));
    };
    const std::int64_t nrhs = own.groups * side_by_side<T>;
    if (staying > 0)
        parallel_for(strips, flops_of_product(staying, nrhs, columns),
                     [&](std::int64_t s) { subtract(s, columns, staying, known); });
    for (std::int64_t s = strips - 1; s >= 0; --s) {
        const std::int64_t first = s * panel_strip, width = std::min(panel_strip, columns - first);
        solve_lower_transposed(width, panel + first + first * rows, rows, own.from(first));
        parallel_for(s, flops_of_product(first, nrhs, width),
                     [&](std::int64_t earlier) { subtract(earlier, first, width, own.from(first)); });
    }
}

template class PanelFactor<float>;
template class PanelFactor<double>;

} // namespace plm
