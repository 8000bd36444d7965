#include "structure/solver/response_products.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/parallel.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <atomic>

namespace plm {

class ResponseProducts {
  public:
    ResponseProducts(const PanelFactor<double> &factor, const SparseMatrix &f, const SparseMatrix &m)
        : p_(factor), m_(m), s_(f.cols), position_(factor.n_), place_(factor.n_, -1) {
        for (std::int64_t i = 0; i < p_.n_; ++i) position_[p_.original_[i]] = i;
        for (std::int64_t node : p_.rest_)
            for (std::int64_t j = p_.first_column_[node]; j < p_.first_column_[node + 1]; ++j) {
                place_[j] = static_cast<std::int64_t>(shared_row_.size());
                shared_row_.push_back(j);
            }
        for (std::int64_t c = 0; c < f.cols; ++c)
            for (std::int64_t k = f.ptr[c]; k < f.ptr[c + 1]; ++k)
                if (f.val[k] != 0) entries_.push_back({position_[f.idx[k]], c, f.val[k]});
        std::sort(entries_.begin(), entries_.end(), [](const Entry &a, const Entry &b) {
            return a.row != b.row ? a.row < b.row : a.column < b.column;
        });
    }

    bool run(Matrix &energy, Matrix &inertia) {
        if (!couples_as_the_factor()) return false;
        std::vector<Sums> sums(groups + 1);
        for (Sums &one : sums) one = {Matrix(s_, s_), Matrix(s_, s_)};
        solve_shared();
        to_columns(shared_, s_);
        add_shared(sums[groups]);
        to_lanes(shared_);
        const auto count = static_cast<std::int64_t>(p_.subtrees_.size());
        parallel_for(groups, [&](std::int64_t group) {
            for (std::int64_t k = group; k < count; k += groups)
                add_subtree(p_.subtrees_[k], sums[static_cast<std::size_t>(group)]);
        });
        energy.reset(s_, s_);
        inertia.reset(s_, s_);
        for (const Sums &one : sums)
            for (std::int64_t j = 0; j < s_; ++j)
                for (std::int64_t i = 0; i < s_; ++i) {
                    energy(i, j) += 0.5 * (one.energy(i, j) + one.energy(j, i));
                    inertia(i, j) += 0.5 * (one.inertia(i, j) + one.inertia(j, i));
                }
        return true;
    }

  private:
    using Factor = PanelFactor<double>;
    using Subtree = Factor::Subtree;
    using Rows = Factor::Rows;
    struct Entry { // of F
        std::int64_t row, column;
        double value;
    };
    struct Sums {
        Matrix energy, inertia;
    };
    struct Span {
        const Entry *first, *last;
    };
    /// Subtrees are added up in so many sums, whatever the number of threads.
    static constexpr std::int64_t groups = 8;

    std::int64_t begin_of(const Subtree &t) const { return p_.first_column_[t.first]; }
    std::int64_t end_of(const Subtree &t) const { return p_.first_column_[t.last + 1]; }

    /// Two rows share a subtree, or one is above the other.
    bool couples_as_the_factor() const {
        std::atomic<bool> all{true};
        parallel_for(static_cast<std::int64_t>(p_.subtrees_.size()), 10 * static_cast<double>(m_.nnz()),
                     [&](std::int64_t k) {
                         const Subtree &t = p_.subtrees_[k];
                         const std::int64_t begin = begin_of(t), end = end_of(t);
                         const std::int64_t *above = p_.rows_below(t.last), *last = above + p_.below(t.last);
                         for (std::int64_t j = begin; j < end && all; ++j)
                             for_entries(j, [&](std::int64_t row, double) {
                                 if (row < begin || (row >= end && !std::binary_search(above, last, row)))
                                     all = false;
                             });
                     });
        return all;
    }

    /// body(row, value), of column j of M, both in the new order.
    template <class Body> void for_entries(std::int64_t j, const Body &body) const {
        const std::int64_t column = p_.original_[j];
        for (std::int64_t k = m_.ptr[column]; k < m_.ptr[column + 1]; ++k)
            if (m_.val[k] != 0) body(position_[m_.idx[k]], m_.val[k]);
    }

    Span forces_on(std::int64_t begin, std::int64_t end) const {
        const auto before = [](const Entry &e, std::int64_t row) { return e.row < row; };
        const Entry *first = entries_.data(), *last = first + entries_.size();
        return {std::lower_bound(first, last, begin, before), std::lower_bound(first, last, end, before)};
    }

    /// Columns of F with any of these entries; zero stays zero in the others.
    static vector<std::int64_t> columns_of(const Span &forces) {
        vector<std::int64_t> columns;
        for (const Entry *e = forces.first; e != forces.last; ++e) columns.push_back(e->column);
        std::sort(columns.begin(), columns.end());
        columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
        return columns;
    }

    /// Of a subtree, the columns that forces in it make: of X, and of what it adds to the rows below its
    /// root.
    struct Forward {
        vector<std::int64_t> columns;
        LaneBlock<double> x, above;
    };
    Forward forward(const Subtree &t) const {
        const std::int64_t begin = begin_of(t), rows = end_of(t) - begin;
        const Span forces = forces_on(begin, end_of(t));
        Forward f{columns_of(forces), {}, {}};
        const auto width = static_cast<std::int64_t>(f.columns.size());
        f.x = LaneBlock<double>(rows, width);
        if (width == 0) return f;
        vector<std::int64_t> at(s_);
        for (std::int64_t k = 0; k < width; ++k) at[f.columns[k]] = k;
        for (const Entry *e = forces.first; e != forces.last; ++e)
            f.x(e->row - begin, at[e->column]) += e->value;
        const Rows x{f.x.all(), begin, nullptr};
        p_.forward_subtree(t, x, f.above);
        p_.divide(begin, begin + rows, x, 1);
        return f;
    }

    void solve_shared() {
        const auto count = static_cast<std::int64_t>(p_.subtrees_.size());
        std::vector<LaneBlock<double>> from_subtrees(p_.subtrees_.size());
        parallel_for(count, [&](std::int64_t k) {
            const Forward f = forward(p_.subtrees_[k]);
            if (f.columns.empty()) return;
            const std::int64_t reached = p_.below(p_.subtrees_[k].last);
            LaneBlock<double> &above = from_subtrees[static_cast<std::size_t>(k)];
            above = LaneBlock<double>(reached, s_);
            put_columns(f.above, f.columns, above);
        });
        shared_ = for_lanes(static_cast<std::int64_t>(shared_row_.size()), s_);
        for (const Entry &e : entries_)
            if (place_[e.row] >= 0) lane(shared_, place_[e.row], e.column) += e.value;
        const Rows x{in_lanes(shared_), 0, place_.data()};
        p_.forward_rest(from_subtrees, x);
        for (std::int64_t node : p_.rest_)
            p_.divide(p_.first_column_[node], p_.first_column_[node + 1], x, 1);
        p_.backward_rest(x);
    }

    // What is solved for in lanes is multiplied by columns: it changes from one to the other where it stands.
    static constexpr std::int64_t lanes = side_by_side<double>;
    static Matrix for_lanes(std::int64_t rows, std::int64_t columns) {
        return Matrix(rows, groups_of<double>(columns) * lanes);
    }
    static LaneRows<double> in_lanes(Matrix &a) { return {a.data(), a.rows() * lanes, a.cols() / lanes}; }
    static LaneRows<const double> in_lanes(const Matrix &a) {
        return {a.data(), a.rows() * lanes, a.cols() / lanes};
    }
    static double &lane(Matrix &a, std::int64_t row, std::int64_t column) {
        return in_lanes(a).group(column / lanes)[row * lanes + column % lanes];
    }
    static void to_columns(Matrix &a, std::int64_t columns) {
        vector<double> group(a.rows() * lanes);
        for (std::int64_t first = 0; first < a.cols(); first += lanes) {
            std::copy_n(a.col(first), group.size(), group.data());
            for (std::int64_t k = 0; k < lanes; ++k)
                for (std::int64_t i = 0; i < a.rows(); ++i) a(i, first + k) = group[i * lanes + k];
        }
        a.cut(columns);
    }
    static void to_lanes(Matrix &a) {
        const std::int64_t padding = groups_of<double>(a.cols()) * lanes - a.cols();
        if (padding > 0) a.append(Matrix(a.rows(), padding));
        vector<double> group(a.rows() * lanes);
        for (std::int64_t first = 0; first < a.cols(); first += lanes) {
            std::copy_n(a.col(first), group.size(), group.data());
            double *to = a.col(first);
            for (std::int64_t k = 0; k < lanes; ++k)
                for (std::int64_t i = 0; i < a.rows(); ++i) to[i * lanes + k] = group[i + k * a.rows()];
        }
    }

    static void put_columns(const LaneBlock<double> &from, const vector<std::int64_t> &columns,
                            LaneBlock<double> &to) {
        for (std::size_t c = 0; c < columns.size(); ++c)
            for (std::int64_t i = 0; i < from.rows(); ++i)
                to(i, columns[c]) = from(i, static_cast<std::int64_t>(c));
    }

    void add_shared(Sums &sums) const {
        for (const Entry &e : entries_)
            if (place_[e.row] >= 0)
                for (std::int64_t c = 0; c < s_; ++c)
                    sums.energy(e.column, c) += e.value * shared_(place_[e.row], c);
        const SparseMatrix inner =
            part_of_mass(shared_.rows(), shared_.rows(), [&](std::int64_t i, auto put) {
                for_entries(shared_row_[i], [&](std::int64_t row, double value) {
                    if (place_[row] >= 0) put(place_[row], value);
                });
            });
        add_inertia(shared_, inner, sums.inertia);
    }

    void add_subtree(const Subtree &t, Sums &sums) const {
        const std::int64_t begin = begin_of(t), end = end_of(t);
        Matrix x = for_lanes(end - begin, s_);
        const Forward f = forward(t);
        for (std::size_t c = 0; c < f.columns.size(); ++c)
            for (std::int64_t i = 0; i < x.rows(); ++i)
                lane(x, i, f.columns[c]) = f.x(i, static_cast<std::int64_t>(c));
        p_.backward_subtree(t, {in_lanes(x), begin, nullptr}, {in_lanes(shared_), 0, place_.data()});
        to_columns(x, s_);
        const Span forces = forces_on(begin, end);
        for (const Entry *e = forces.first; e != forces.last; ++e)
            for (std::int64_t c = 0; c < s_; ++c)
                sums.energy(e->column, c) += e->value * x(e->row - begin, c);
        const SparseMatrix inner = part_of_mass(x.rows(), x.rows(), [&](std::int64_t i, auto put) {
            for_entries(begin + i, [&](std::int64_t row, double value) {
                if (row < end) put(row - begin, value);
            });
        });
        add_inertia(x, inner, sums.inertia);
        add_coupling(t, x, sums.inertia);
        worked(static_cast<double>(x.rows() * s_) * static_cast<double>(s_));
    }

    /// X^T M X between the rows of a subtree and those above it: few of its rows have a part in that.
    void add_coupling(const Subtree &t, const Matrix &x, Matrix &sum) const {
        const std::int64_t begin = begin_of(t), end = end_of(t), border = p_.below(t.last);
        const std::int64_t *above = p_.rows_below(t.last);
        vector<std::int64_t> coupled;
        for (std::int64_t j = begin; j < end; ++j) {
            bool reaches_above = false;
            for_entries(j, [&](std::int64_t row, double) { reaches_above |= row >= end; });
            if (reaches_above) coupled.push_back(j - begin);
        }
        Matrix known(border, s_); // rows of X above
        for (std::int64_t c = 0; c < s_; ++c)
            for (std::int64_t i = 0; i < border; ++i)
                known(i, c) = in_lanes(shared_).group(c / lanes)[place_[above[i]] * lanes + c % lanes];
        const auto count = static_cast<std::int64_t>(coupled.size());
        const SparseMatrix outer = part_of_mass(border, count, [&](std::int64_t k, auto put) {
            for_entries(begin + coupled[k], [&](std::int64_t row, double value) {
                if (row >= end) put(std::lower_bound(above, above + border, row) - above, 2 * value);
            });
        });
        gemm('T', 'N', 1.0, select_rows(x, coupled), multiply_transposed(outer, known), 1.0, sum);
    }

    /// Columns of entries that each(column, put) puts, in ascending order of rows.
    template <class Each>
    static SparseMatrix part_of_mass(std::int64_t rows, std::int64_t columns, const Each &each) {
        SparseMatrix a;
        a.rows = rows;
        a.cols = columns;
        a.ptr.assign(columns + 1, 0);
        std::vector<std::pair<std::int64_t, double>> column;
        for (std::int64_t j = 0; j < columns; ++j) {
            column.clear();
            each(j, [&](std::int64_t row, double value) { column.emplace_back(row, value); });
            std::sort(column.begin(), column.end());
            for (const auto &[row, value] : column) {
                a.idx.push_back(row);
                a.val.push_back(value);
            }
            a.ptr[j + 1] = static_cast<std::int64_t>(a.idx.size());
        }
        return a;
    }

    /// X^T M X by blocks of columns, of which the symmetric part is meant: what stands below the blocks of
    /// the diagonal counts twice, and nothing stands above them.
    static void add_inertia(const Matrix &x, const SparseMatrix &mass, Matrix &sum) {
        constexpr std::int64_t block = 64;
        const std::int64_t s = x.cols(), n = x.rows();
        for (std::int64_t first = 0; first < s; first += block) {
            const std::int64_t width = std::min(block, s - first), next = first + width;
            const Matrix momenta = multiply_transposed(mass, x.columns(first, width));
            const auto add = [&](std::int64_t begin, std::int64_t height, double factor) {
                if (height > 0)
                    gemm('T', height, width, n, factor, x.col(begin), n, momenta.data(), n, 1.0,
                         sum.col(first) + begin, s);
            };
            add(first, width, 1.0);
            add(next, s - next, 2.0);
        }
    }

    const Factor &p_;
    const SparseMatrix &m_;
    const std::int64_t s_;
    vector<std::int64_t> position_; // new order of each row of A
    vector<std::int64_t> place_;    // of each row in the new order: among those above the subtrees, or -1
    vector<std::int64_t> shared_row_;
    vector<Entry> entries_; // by rows in the new order
    Matrix shared_;         // X above the subtrees, in lanes
};

bool multiply_responses(const PanelFactor<double> &factor, const SparseMatrix &f, const SparseMatrix &m,
                        Matrix &energy, Matrix &inertia) {
    return ResponseProducts(factor, f, m).run(energy, inertia);
}

} // namespace plm
