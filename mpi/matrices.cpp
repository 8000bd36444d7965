#include "mpi/matrices.hpp"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace plm::mpi {
namespace {

void sort_and_unite(std::vector<std::int64_t> &list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

std::size_t place_in(const std::vector<std::int64_t> &sorted, std::int64_t value) {
    return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
}

/// What all ranks have of the entries in rows and columns of this one, summed in the order of the ranks: the
/// owners of an entry's row and of its column come to the same number.
std::vector<Entry> shared(Team &team, const Rows &rows, EntryList &parts) {
    std::vector<Entry> sum, out;
    std::vector<std::int64_t> foreign;
    team.together([&] {
        sum = parts.take();
        for (const Entry &e : sum)
            for (std::int64_t dof : {e.row, e.col})
                if (rows.local(dof) < 0) foreign.push_back(dof);
        sort_and_unite(foreign);
    });
    const std::vector<int> owner = rows.owners_of(team, foreign);
    std::vector<int> to, from;
    team.together([&] {
        const auto owner_of = [&](std::int64_t dof) {
            return rows.local(dof) >= 0 ? team.rank() : owner[place_in(foreign, dof)];
        };
        std::size_t kept = 0;
        for (const Entry &e : sum) {
            const int of_row = owner_of(e.row), of_col = owner_of(e.col);
            if (of_row != team.rank()) out.push_back(e), to.push_back(of_row);
            if (of_col != team.rank() && of_col != of_row) out.push_back(e), to.push_back(of_col);
            if (of_row == team.rank() || of_col == team.rank()) sum[kept++] = e;
        }
        sum.resize(kept);
    });
    std::vector<Entry> before = deliver(team, out, to, &from);
    team.together([&] {
        const auto own = std::lower_bound(from.begin(), from.end(), team.rank()) - from.begin();
        std::vector<Entry> after(before.begin() + own, before.end());
        before.resize(static_cast<std::size_t>(own));
        sort_by_place(before), sort_by_place(after);
        if (!before.empty()) sum = merged(merged({}, before), sum);
        if (!after.empty()) sum = merged(sum, after);
    });
    return sum;
}

/// Places of any of the matrices, by rows: visit(row, column, the values of M, K, C there).
template <class Lists, class Visit> void places(const Lists &lists, Visit visit) {
    std::size_t at[3] = {0, 0, 0};
    for (;;) {
        const Entry *next = nullptr;
        for (int w = 0; w < 3; ++w)
            if (at[w] < lists[w].size() && (!next || stands_before(lists[w][at[w]], *next)))
                next = &lists[w][at[w]];
        if (!next) return;
        const std::int64_t row = next->row, col = next->col;
        double value[3] = {0, 0, 0};
        for (int w = 0; w < 3; ++w)
            if (at[w] < lists[w].size() && lists[w][at[w]].row == row && lists[w][at[w]].col == col)
                value[w] = lists[w][at[w]++].value;
        visit(row, col, value);
    }
}

const char *const name[3] = {"the mass matrix", "the stiffness matrix", "the damping matrix"};

} // namespace

Matrices::Matrices(Team &team, const Rows &rows, MatrixParts &parts) {
    Lists lists;
    for (std::size_t which = 0; which < 3; ++which) lists[which] = shared(team, rows, parts.entries[which]);
    require_symmetric(team, lists);
    take_supports(team, rows, parts.fixed);
    find_ghosts(team, rows, lists);
    has_damping_ = team.sum(std::int64_t(parts.has_damping)) > 0;
    team.together([&] { store(rows, lists); });
}

void Matrices::require_symmetric(Team &team, const Lists &lists) const {
    for (std::size_t which = 0; which < 3; ++which) {
        double here = 0;
        for (const Entry &e : lists[which]) here = std::max(here, std::abs(e.value));
        const double largest = team.largest(here);
        team.together([&] {
            for (const Entry &e : lists[which])
                if (std::abs(2 * e.skew) > 1e-8 * largest)
                    throw Error(
                        status::matrix,
                        format("%s is not symmetric: entries (%d, %d) and (%d, %d) (base 0), summed "
                               "over all ranks, are %g apart, more than 1e-8 of the largest entry %g; "
                               "pass PLM_LOWER or PLM_UPPER to hand over one triangle",
                               name[which], e.row, e.col, e.col, e.row, std::abs(2 * e.skew), largest))
                        .argument("value")
                        .index(e.row);
        });
    }
}

void Matrices::take_supports(Team &team, const Rows &rows, const std::vector<std::int64_t> &fixed) {
    const std::vector<int> owner = rows.owners_of(team, fixed);
    const std::vector<std::int64_t> mine = deliver(team, fixed, owner);
    team.together([&] {
        fixed_.assign(static_cast<std::size_t>(rows.count()), 0);
        for (std::int64_t dof : mine) fixed_[static_cast<std::size_t>(rows.local(dof))] = 1;
    });
}

void Matrices::find_ghosts(Team &team, const Rows &rows, const Lists &lists) {
    team.together([&] {
        for (const auto &list : lists)
            for (const Entry &e : list)
                if (rows.local(e.row) < 0)
                    ghosts_.push_back(e.row);
                else if (rows.local(e.col) < 0)
                    ghosts_.push_back(e.col);
        sort_and_unite(ghosts_);
    });
    halo_ = Exchange::pull(team, rows, ghosts_);
    std::vector<double> support;
    team.together([&] {
        ghost_.resize(ghosts_.size() * Exchange::width);
        abreast_.resize((fixed_.size() + ghosts_.size()) * abreast);
        support.assign(fixed_.begin(), fixed_.end());
    });
    halo_.run(team, 1, support.data(), rows.count(), ghost_.data(), ghost_rows());
}

/// By rows, without those of supports: ghost_ tells of the supports of others. Each place goes to its row
/// and, mirrored, to that of its column: columns ascend in each row, as the lists do.
void Matrices::store(const Rows &rows, const Lists &lists) {
    const auto each = [&](auto visit) { // visit(own row, column as in column_, values)
        places(lists, [&](std::int64_t i, std::int64_t j, const double *value) {
            const std::int64_t row = rows.local(i), col = rows.local(j);
            const auto place = [&](std::int64_t own, std::int64_t dof) {
                return own >= 0 ? own : this->rows() + static_cast<std::int64_t>(place_in(ghosts_, dof));
            };
            const auto held = [&](std::int64_t at) {
                return at < this->rows() ? fixed(at)
                                         : ghost_[static_cast<std::size_t>(at - this->rows())] != 0;
            };
            const std::int64_t here = place(row, i), there = place(col, j);
            if (held(here) || held(there)) return;
            if (row >= 0) visit(row, there, value);
            if (col >= 0 && i != j) visit(col, here, value);
        });
    };
    start_.assign(fixed_.size() + 1, 0);
    each(
        [&](std::int64_t row, std::int64_t, const double *) { ++start_[static_cast<std::size_t>(row) + 1]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    column_.resize(start_.back());
    for (std::size_t w = 0; w < (has_damping_ ? 3 : 2); ++w) value_[w].resize(start_.back());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    each([&](std::int64_t row, std::int64_t column, const double *value) {
        const std::size_t p = next[static_cast<std::size_t>(row)]++;
        column_[p] = static_cast<std::int32_t>(column);
        for (std::size_t w = 0; w < (has_damping_ ? 3 : 2); ++w) value_[w][p] = value[w];
    });
}

double Matrices::diagonal(std::int64_t row, const Weights &w) const {
    for (std::size_t p = start_[static_cast<std::size_t>(row)]; p < start_[static_cast<std::size_t>(row) + 1];
         ++p)
        if (column_[p] == row) return entry(p, w);
    return 0;
}

bool Matrices::row_of_stiffness_is_empty(std::int64_t row) const {
    for (std::size_t p = start_[static_cast<std::size_t>(row)]; p < start_[static_cast<std::size_t>(row) + 1];
         ++p)
        if (value_[1][p] != 0) return false;
    return true;
}

double Matrices::largest(const Weights &w) const {
    double most = 0;
    for (std::size_t p = 0; p < column_.size(); ++p) most = std::max(most, std::abs(entry(p, w)));
    return most;
}

void Matrices::apply(Team &team, const Weights &w, std::int64_t cols, const double *y, std::int64_t ld_y,
                     double *x, std::int64_t ld_x) {
    halo_.run(team, cols, y, ld_y, ghost_.data(), ghost_rows());
    const auto with = [&](auto value) {
        for (std::int64_t first = 0; first < cols;)
            if (cols - first == 1)
                first += multiply<1>(value, first, cols, y, ld_y, x, ld_x);
            else
                first += multiply<abreast>(value, first, cols, y, ld_y, x, ld_x);
    };
    const double *m = value_[0].data(), *k = value_[1].data();
    if (w.k == 0 && w.c == 0)
        with([=](std::size_t p) { return w.m * m[p]; });
    else if (w.m == 0 && w.c == 0)
        with([=](std::size_t p) { return w.k * k[p]; });
    else
        with([&](std::size_t p) { return entry(p, w); });
}

/// At most `width` columns from `first` on, of which the entries of a row stand side by side meanwhile: one
/// pass over the matrix, and one place in memory for each of its entries.
template <int width, class Value>
std::int64_t Matrices::multiply(Value value, std::int64_t first, std::int64_t cols, const double *y,
                                std::int64_t ld_y, double *x, std::int64_t ld_x) {
    const std::int64_t n = std::min<std::int64_t>(width, cols - first);
    double *by_rows = abreast_.data();
    const auto pack = [&](const double *from, std::int64_t count, std::int64_t ld) {
        for (std::int64_t i = 0; i < count; ++i, by_rows += width)
            for (int j = 0; j < width; ++j) by_rows[j] = j < n ? from[i + (first + j) * ld] : 0;
    };
    pack(y, rows(), ld_y), pack(ghost_.data(), ghost_rows(), ghost_rows());
    for (std::int64_t i = 0; i < rows(); ++i) {
        double sum[width] = {};
        for (std::size_t p = start_[static_cast<std::size_t>(i)]; p < start_[static_cast<std::size_t>(i) + 1];
             ++p) {
            const double a = value(p);
            const double *row = abreast_.data() + static_cast<std::ptrdiff_t>(column_[p]) * width;
            for (int j = 0; j < width; ++j) sum[j] += a * row[j];
        }
        for (std::int64_t j = 0; j < n; ++j) x[i + (first + j) * ld_x] = sum[j];
    }
    return n;
}

void Matrices::energy(Team &team, const Weights &w, std::int64_t cols, const double *x, std::int64_t ld,
                      double *sums) {
    halo_.run(team, cols, x, ld, ghost_.data(), ghost_rows());
    for (std::int64_t j = 0; j < cols; ++j) {
        Exact total;
        double size = 0;
        for (std::int64_t i = 0; i < rows(); ++i) {
            Exact row;
            double terms = 0;
            const double xi = x[i + j * ld];
            for (std::size_t p = start_[static_cast<std::size_t>(i)];
                 p < start_[static_cast<std::size_t>(i) + 1]; ++p) {
                const double a = entry(p, w), y = of(x, ld, column_[p], j);
                row.add_product(a, y);
                terms += std::abs(a * y);
            }
            total.add_product(xi, row.high);
            total.low += xi * row.low;
            size += std::abs(xi) * terms;
        }
        sums[3 * j] = total.high, sums[3 * j + 1] = total.low, sums[3 * j + 2] = size;
    }
}

void Matrices::residual(Team &team, double rounding, std::int64_t cols, const double *x, const double *y,
                        std::int64_t ld_x, std::int64_t ld_y, const double *lambda, double *squares) {
    halo_.run(team, cols, x, ld_x, ghost_.data(), ghost_rows());
    for (std::int64_t j = 0; j < cols; ++j) {
        double sum = 0;
        for (std::int64_t i = 0; i < rows(); ++i) {
            double kx = 0, size = 0;
            for (std::size_t p = start_[static_cast<std::size_t>(i)];
                 p < start_[static_cast<std::size_t>(i) + 1]; ++p) {
                const double term = value_[1][p] * of(x, ld_x, column_[p], j);
                kx += term, size += std::abs(term);
            }
            const double left = std::abs(kx - lambda[j] * y[i + j * ld_y]) - rounding * size;
            if (!std::isfinite(kx)) sum = NAN;
            if (left > 0) sum += left * left;
        }
        squares[j] = sum;
    }
}

} // namespace plm::mpi
