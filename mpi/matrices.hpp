// M, K and C by rows: each rank has those it owns, summed over all that the ranks assembled.
#pragma once
#include "mpi/entries.hpp"
#include "mpi/exchange.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace plm::mpi {

/// m M + k K + c C.
struct Weights {
    double m = 0, k = 0, c = 0;
};

/// What the ranks handed over: entries of M, K, C; supports, perhaps of DOFs of other ranks.
struct MatrixParts {
    std::array<EntryList, 3> entries;
    std::vector<std::int64_t> fixed;
    bool has_damping = false;
};

/// A sum with twice the digits: the rounded number and what rounding left of it.
struct Exact {
    double high = 0, low = 0;
    void add(double x) {
        const double s = high + x, part = s - high;
        low += (high - (s - part)) + (x - part);
        high = s;
    }
    void add_product(double a, double b) {
        const double p = a * b;
        low += std::fma(a, b, -p);
        add(p);
    }
};

class Matrices {
  public:
    Matrices() = default;
    /// Collective. Takes the entries out of the parts.
    Matrices(Team &team, const Rows &rows, MatrixParts &parts);

    std::int64_t rows() const { return static_cast<std::int64_t>(fixed_.size()); }
    /// A support: the row and column are empty, and every tall column is zero there.
    bool fixed(std::int64_t row) const { return fixed_[static_cast<std::size_t>(row)] != 0; }
    bool has_damping() const { return has_damping_; }

    double diagonal(std::int64_t row, const Weights &w) const;
    bool row_of_stiffness_is_empty(std::int64_t row) const;
    /// Largest absolute entry of this rank's rows.
    double largest(const Weights &w) const;
    /// Entries of the lower triangle in the rows of this rank: visit(row, column, value), DOFs base 0.
    template <class Visit> void lower_entries(const Rows &rows, const Weights &w, Visit visit) const {
        for (std::int64_t i = 0; i < this->rows(); ++i) {
            const std::int64_t dof = rows.owned()[static_cast<std::size_t>(i)];
            for (std::size_t p = start_[static_cast<std::size_t>(i)];
                 p < start_[static_cast<std::size_t>(i) + 1]; ++p)
                if (dof_of_column(rows, column_[p]) <= dof)
                    visit(dof, dof_of_column(rows, column_[p]), entry(p, w));
        }
    }
    /// Where the entries of a row of this rank stand: own rows, and from rows() on DOFs of other ranks.
    struct Columns {
        const std::int32_t *first, *last;
        const std::int32_t *begin() const { return first; }
        const std::int32_t *end() const { return last; }
        bool operator==(const Columns &other) const {
            return std::equal(first, last, other.first, other.last);
        }
    };
    Columns columns(std::int64_t row) const {
        const auto i = static_cast<std::size_t>(row);
        return {column_.data() + start_[i], column_.data() + start_[i + 1]};
    }
    std::int64_t dof_of_column(const Rows &rows, std::int64_t column) const {
        return column < this->rows() ? rows.owned()[static_cast<std::size_t>(column)]
                                     : ghosts_[static_cast<std::size_t>(column - this->rows())];
    }
    std::int64_t entries_here() const { return static_cast<std::int64_t>(column_.size()); }

    /// Collective, cannot fail for want of memory; cols at most Exchange::width. X = A Y.
    void apply(Team &team, const Weights &w, std::int64_t cols, const double *y, std::int64_t ld_y, double *x,
               std::int64_t ld_x);
    /// Collective; sums over this rank's rows. Of each column x' A x in two numbers, high and low, with twice
    /// the digits, and |x|' |A| |x|: 3 numbers a column.
    void energy(Team &team, const Weights &w, std::int64_t cols, const double *x, std::int64_t ld,
                double *sums);
    /// Collective; sums over this rank's rows of max(0, |K x - lambda y| - rounding |K| |x|)^2.
    void residual(Team &team, double rounding, std::int64_t cols, const double *x, const double *y,
                  std::int64_t ld_x, std::int64_t ld_y, const double *lambda, double *squares);

  private:
    /// Of M, K, C: the lower triangle's entries in rows or columns of this rank.
    using Lists = std::array<std::vector<Entry>, 3>;
    void require_symmetric(Team &team, const Lists &lists) const;
    void take_supports(Team &team, const Rows &rows, const std::vector<std::int64_t> &fixed);
    void find_ghosts(Team &team, const Rows &rows, const Lists &lists);
    void store(const Rows &rows, const Lists &lists);

    static constexpr int abreast = 8; // columns that one pass over the matrix multiplies
    template <int width, class Value>
    std::int64_t multiply(Value value, std::int64_t first, std::int64_t cols, const double *y,
                          std::int64_t ld_y, double *x, std::int64_t ld_x);

    double entry(std::size_t p, const Weights &w) const {
        return w.m * value_[0][p] + w.k * value_[1][p] + (w.c != 0 ? w.c * value_[2][p] : 0);
    }
    /// Value of a column's entry, own or of another rank.
    const double &of(const double *y, std::int64_t ld, std::int64_t column, std::int64_t j) const {
        return column < rows() ? y[column + j * ld] : ghost_[column - rows() + j * ghost_rows()];
    }
    std::int64_t ghost_rows() const { return static_cast<std::int64_t>(ghosts_.size()); }

    bool has_damping_ = false;
    std::vector<char> fixed_;
    std::vector<std::int64_t> ghosts_; // DOFs of other ranks that rows here refer to, ascending
    std::vector<double> ghost_;        // their values, Exchange::width columns
    std::vector<double> abreast_;      // entries of own rows and ghosts, side by side
    Exchange halo_;
    std::vector<std::size_t> start_;
    std::vector<std::int32_t> column_; // local row, or rows() + place among the ghosts
    std::array<std::vector<double>, 3> value_;
};

} // namespace plm::mpi
