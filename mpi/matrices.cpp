#include "mpi/matrices.hpp"
#include <algorithm>
#include <cmath>

namespace plm::mpi {
namespace {

void sort_and_unite(std::vector<std::int64_t> &list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

std::size_t place_in(const std::vector<std::int64_t> &sorted, std::int64_t value) {
    return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
}

const char *const name[3] = {"the mass matrix", "the stiffness matrix", "the damping matrix"};

} // namespace

Matrices::Matrices(Team &team, const Rows &rows, const MatrixParts &parts) {
    const std::vector<Element> elements = gather(team, rows, parts);
    require_symmetric(team, elements);
    take_supports(team, rows, parts.fixed);
    find_ghosts(team, rows, elements);
    has_damping_ = team.sum(std::int64_t(parts.has_damping)) > 0;
    team.together([&] { store(rows, elements); });
}

/// Each entry goes to the owner of its row and, mirrored, to that of its column, where all parts of it are
/// summed.
std::vector<Matrices::Element> Matrices::gather(Team &team, const Rows &rows, const MatrixParts &parts) {
    std::vector<std::int64_t> dofs;
    team.together([&] {
        for (const auto &list : parts.entries)
            for (const Entry &e : list) dofs.push_back(e.row), dofs.push_back(e.col);
        sort_and_unite(dofs);
    });
    const std::vector<int> owner = rows.owners_of(team, dofs);
    std::vector<Element> out;
    std::vector<int> to;
    team.together([&] {
        for (std::size_t which = 0; which < 3; ++which)
            for (const Entry &e : parts.entries[which]) {
                Element one{e.row, e.col, {0, 0, 0}, {0, 0, 0}}, mirrored{e.col, e.row, {0, 0, 0}, {0, 0, 0}};
                one.value[which] = mirrored.value[which] = e.value;
                one.skew[which] = mirrored.skew[which] = e.skew;
                out.push_back(one), to.push_back(owner[place_in(dofs, e.row)]);
                if (e.row == e.col) continue;
                out.push_back(mirrored), to.push_back(owner[place_in(dofs, e.col)]);
            }
    });
    std::vector<Element> in = deliver(team, out, to);
    team.together([&] {
        // stable: the parts of an entry and of its mirror image are summed in one order
        std::stable_sort(in.begin(), in.end(), [](const Element &a, const Element &b) {
            return a.row != b.row ? a.row < b.row : a.col < b.col;
        });
        std::size_t n = 0;
        for (std::size_t k = 0; k < in.size(); ++k) {
            if (n == 0 || in[n - 1].row != in[k].row || in[n - 1].col != in[k].col) {
                in[n++] = in[k];
                continue;
            }
            for (int which = 0; which < 3; ++which)
                in[n - 1].value[which] += in[k].value[which], in[n - 1].skew[which] += in[k].skew[which];
        }
        in.resize(n);
    });
    return in;
}

void Matrices::require_symmetric(Team &team, const std::vector<Element> &elements) const {
    for (int which = 0; which < 3; ++which) {
        double here = 0;
        for (const Element &e : elements) here = std::max(here, std::abs(e.value[which]));
        const double largest = team.largest(here);
        team.together([&] {
            for (const Element &e : elements)
                if (std::abs(2 * e.skew[which]) > 1e-8 * largest)
                    throw Error(
                        status::matrix,
                        format(
                            "%s is not symmetric: entries (%lld, %lld) and (%lld, %lld) (base 0), summed "
                            "over all "
                            "ranks, are %g apart, more than 1e-8 of the largest entry %g; pass PLM_LOWER or "
                            "PLM_UPPER to hand over one triangle",
                            name[which], static_cast<long long>(e.row), static_cast<long long>(e.col),
                            static_cast<long long>(e.col), static_cast<long long>(e.row),
                            std::abs(2 * e.skew[which]), largest))
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

void Matrices::find_ghosts(Team &team, const Rows &rows, const std::vector<Element> &elements) {
    team.together([&] {
        for (const Element &e : elements)
            if (rows.local(e.col) < 0) ghosts_.push_back(e.col);
        sort_and_unite(ghosts_);
    });
    halo_ = Exchange::pull(team, rows, ghosts_);
    std::vector<double> support;
    team.together([&] {
        ghost_.resize(ghosts_.size() * Exchange::width);
        support.assign(fixed_.begin(), fixed_.end());
    });
    halo_.run(team, 1, support.data(), rows.count(), ghost_.data(), ghost_rows());
}

/// By rows, without those of supports: ghost_ tells of the supports of others.
void Matrices::store(const Rows &rows, const std::vector<Element> &elements) {
    start_.assign(fixed_.size() + 1, 0);
    for (const Element &e : elements) {
        const std::int64_t row = rows.local(e.row);
        std::int64_t column = rows.local(e.col);
        const bool own = column >= 0;
        const std::size_t ghost = own ? 0 : place_in(ghosts_, e.col);
        if (fixed(row) || (own ? fixed(column) : ghost_[ghost] != 0)) continue;
        if (!own) column = this->rows() + static_cast<std::int64_t>(ghost);
        column_.push_back(column);
        value_[0].push_back(e.value[0]), value_[1].push_back(e.value[1]);
        if (has_damping_) value_[2].push_back(e.value[2]);
        start_[static_cast<std::size_t>(row) + 1] = column_.size();
    }
    for (std::size_t i = 1; i < start_.size(); ++i) start_[i] = std::max(start_[i], start_[i - 1]);
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
    for (std::int64_t first = 0; first < cols; first += 4) { // four columns for each pass over the matrix
        const std::int64_t n = std::min<std::int64_t>(4, cols - first);
        for (std::int64_t i = 0; i < rows(); ++i) {
            double sum[4] = {0, 0, 0, 0};
            for (std::size_t p = start_[static_cast<std::size_t>(i)];
                 p < start_[static_cast<std::size_t>(i) + 1]; ++p) {
                const double a = entry(p, w);
                for (std::int64_t j = 0; j < n; ++j) sum[j] += a * of(y, ld_y, column_[p], first + j);
            }
            for (std::int64_t j = 0; j < n; ++j) x[i + (first + j) * ld_x] = sum[j];
        }
    }
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
