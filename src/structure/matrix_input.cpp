#include "structure/matrix_input.hpp"
#include "linalg/scale.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Int = long long; // for printf

/// The caller's arrays with everything that is needed to read them as (row, column, value) entries of base 0.
template <class Index> class Reader {
  public:
    Reader(const MatrixFormat &f, const Index *a, const Index *b, const double *value)
        : f_(f), a_(a), b_(b), value_(value) {}

    void check() const {
        if (compressed()) check_pointers();
        check_entries();
        const bool regular = is_symmetric_at_a_glance(); // then none is given twice
        if (compressed() && !regular) check_duplicates();
        if (!f_.negative_diagonal) check_diagonal();
        if (f_.part == part::full && !regular) check_symmetry();
    }

    SparseMatrix mirrored() const {
        SparseMatrix a;
        if (mirrored_in_place(a)) return a;
        vector<std::int64_t> i, j;
        vector<double> v;
        const std::size_t most = static_cast<std::size_t>(f_.part == part::full ? f_.nnz : 2 * f_.nnz);
        i.reserve(most), j.reserve(most), v.reserve(most);
        const auto put = [&](std::int64_t row, std::int64_t col, double value) {
            i.push_back(row), j.push_back(col), v.push_back(value);
        };
        for_each([&](std::int64_t, std::int64_t row, std::int64_t col, double value) {
            if (f_.part == part::full && row < col) return; // the lower triangle speaks for both
            put(row, col, value);
            if (row != col) put(col, row, value);
        });
        return from_triplets(f_.n, f_.n, i, j, v);
    }

  private:
    bool compressed() const { return f_.storage != storage::triplets; }
    bool by_columns() const { return f_.storage == storage::csc; }

    /// visit(position, row, column, value) over the stored entries, base 0.
    template <class Visit> void for_each(Visit visit) const {
        const std::int64_t base = f_.index_base;
        if (!compressed()) {
            for (std::int64_t p = 0; p < f_.nnz; ++p) visit(p, a_[p] - base, b_[p] - base, value_[p]);
            return;
        }
        for (std::int64_t k = 0; k < f_.n; ++k)
            for (std::int64_t p = a_[k] - base; p < a_[k + 1] - base; ++p) {
                const std::int64_t other = b_[p] - base;
                by_columns() ? visit(p, other, k, value_[p]) : visit(p, k, other, value_[p]);
            }
    }

    /// visit(p, q) over the positions of mirror images in a compressed full matrix; by columns, p is below
    /// the diagonal. False where entries do not ascend or one has no mirror image: then not all were visited.
    template <class Visit> bool for_each_couple(Visit visit) const {
        const Index base = static_cast<Index>(f_.index_base);
        vector<Index> next(a_, a_ + f_.n); // of each column: the first entry not yet met as a mirror image
        for (std::int64_t k = 0; k < f_.n; ++k) {
            std::int64_t p = next[k] - base, last = k;
            const std::int64_t end = a_[k + 1] - base;
            if (p < end && b_[p] - base == k) ++p;
            for (; p < end; ++p) {
                const std::int64_t other = b_[p] - base;
                if (other <= last) return false;
                last = other;
                const std::int64_t q = next[other] - base;
                if (q >= a_[other + 1] - base || b_[q] - base != k) return false;
                ++next[other];
                visit(p, q);
            }
        }
        return true;
    }

    // As most hosts have it: nothing has to be sorted.
    bool mirrored_in_place(SparseMatrix &a) const {
        if (!compressed() || f_.part != part::full) return false;
        a.rows = a.cols = f_.n;
        a.ptr.assign(a_, a_ + f_.n + 1);
        a.idx.assign(b_, b_ + f_.nnz);
        a.val.assign(value_, value_ + f_.nnz);
        for (std::int64_t &p : a.ptr) p -= f_.index_base;
        for (std::int64_t &i : a.idx) i -= f_.index_base;
        return for_each_couple([&](std::int64_t p, std::int64_t q) { // the lower triangle speaks for both
            a.val[p] = a.val[q] = value_[by_columns() ? p : q];
        });
    }

    std::string entry_name(std::int64_t row, std::int64_t col) const {
        return format("row %lld, column %lld (counted from %d)", Int(row + f_.index_base),
                      Int(col + f_.index_base), f_.index_base);
    }

    [[noreturn]] static void fail(const char *argument, std::int64_t index, const std::string &text) {
        throw Error(status::matrix, text).argument(argument).index(index);
    }

    void check_pointers() const {
        const char *kind = by_columns() ? "column" : "row";
        if (a_[0] != f_.index_base)
            fail(
                "a", 0,
                format("a[0] = %lld must be the index base %d; check index_base", Int(a_[0]), f_.index_base));
        for (std::int64_t k = 0; k < f_.n; ++k)
            if (a_[k + 1] < a_[k] || a_[k + 1] - f_.index_base > f_.nnz)
                fail("a", k + 1,
                     format("a[%lld] = %lld: the %s pointers must not decrease nor go beyond nnz + "
                            "index_base = %lld",
                            Int(k + 1), Int(a_[k + 1]), kind, Int(f_.nnz + f_.index_base)));
        if (a_[f_.n] - f_.index_base != f_.nnz)
            fail("a", f_.n,
                 format("a[%lld] = %lld must be nnz + index_base = %lld; check nnz and the %s pointers",
                        Int(f_.n), Int(a_[f_.n]), Int(f_.nnz + f_.index_base), kind));
    }

    void check_range(const char *argument, const Index *numbers, const char *kind, std::int64_t p) const {
        const std::int64_t number = numbers[p], base = f_.index_base;
        if (number >= base && number - base < f_.n) return;
        fail(argument, p,
             format("%s[%lld] = %lld is no %s number: it must lie in %lld..%lld; check index_base and the "
                    "size of the model",
                    argument, Int(p), Int(number), kind, Int(base), Int(base + f_.n - 1)));
    }

    void check_entries() const {
        for (std::int64_t p = 0; p < f_.nnz; ++p) {
            if (!compressed()) check_range("a", a_, "row", p);
            check_range("b", b_, by_columns() ? "row" : "column", p);
        }
        for_each([&](std::int64_t p, std::int64_t row, std::int64_t col, double value) {
            if (!std::isfinite(value))
                fail("value", p,
                     format("value[%lld] is NaN or infinite, at %s; look for a failed element there", Int(p),
                            entry_name(row, col).c_str()));
            if (too_large(value))
                fail("value", p,
                     format("value[%lld] is %g, at %s; beyond %g squares and products overflow: look for a "
                            "failed element there, or choose other units",
                            Int(p), value, entry_name(row, col).c_str(), largest_scale));
            if ((f_.part == part::lower && row < col) || (f_.part == part::upper && row > col))
                fail("b", p,
                     format("b[%lld]: the entry at %s is not in the %s triangle; pass %s or drop it", Int(p),
                            entry_name(row, col).c_str(), f_.part == part::lower ? "lower" : "upper",
                            f_.part == part::lower ? "PLM_FULL or PLM_UPPER" : "PLM_FULL or PLM_LOWER"));
        });
    }

    void check_duplicates() const {
        vector<std::int64_t> seen(static_cast<std::size_t>(f_.n),
                                  -1); // by number: the last column that had it
        for_each([&](std::int64_t p, std::int64_t row, std::int64_t col, double) {
            const std::int64_t k = by_columns() ? col : row, other = by_columns() ? row : col;
            if (seen[other] == k)
                fail("b", p,
                     format("b[%lld]: the entry at %s is given twice; sum it or pass PLM_TRIPLETS", Int(p),
                            entry_name(row, col).c_str()));
            seen[other] = k;
        });
    }

    void check_diagonal() const {
        vector<double> diagonal(static_cast<std::size_t>(f_.n), 0.0);
        vector<std::int64_t> position(static_cast<std::size_t>(f_.n), -1);
        for_each([&](std::int64_t p, std::int64_t row, std::int64_t col, double value) {
            if (row == col) diagonal[row] += value, position[row] = p;
        });
        for (std::int64_t i = 0; i < f_.n; ++i)
            if (diagonal[i] < 0)
                fail("value", position[i],
                     format("value[%lld]: the diagonal entry at %s is negative (%g); mass and stiffness are "
                            "positive semi-definite, check the sign of the element matrices",
                            Int(position[i]), entry_name(i, i).c_str(), diagonal[i]));
    }

    SparseMatrix as_stored() const {
        vector<std::int64_t> i, j;
        vector<double> v(value_, value_ + f_.nnz);
        i.reserve(static_cast<std::size_t>(f_.nnz)), j.reserve(static_cast<std::size_t>(f_.nnz));
        // Triplets keep their order; compressed forms are visited in storage order, too.
        for_each([&](std::int64_t, std::int64_t row, std::int64_t col, double) {
            i.push_back(row), j.push_back(col);
        });
        return from_triplets(f_.n, f_.n, i, j, v);
    }

    std::int64_t position_of(std::int64_t row, std::int64_t col) const {
        std::int64_t found = -1;
        for_each([&](std::int64_t p, std::int64_t r, std::int64_t c, double) {
            if (r == row && c == col) found = p;
        });
        return found;
    }

    void check_symmetry() const {
        const SparseMatrix s = as_stored(), t = transpose(s);
        double largest = 0;
        for (double v : s.val) largest = std::max(largest, std::abs(v));
        const auto compare = [&](std::int64_t row, std::int64_t col, double one, double other) {
            if (std::abs(one - other) <= 1e-8 * largest) return;
            const std::int64_t p = position_of(row, col);
            fail("value", p >= 0 ? p : position_of(col, row),
                 format("the matrix is not symmetric: %.10g at %s but %.10g at the mirrored place, more than "
                        "1e-8 of the largest entry %g apart; pass PLM_LOWER or PLM_UPPER to use one triangle",
                        one, entry_name(row, col).c_str(), other, largest));
        };
        for (std::int64_t c = 0; c < f_.n; ++c) { // merge column c of S and of its transpose
            std::int64_t p = s.ptr[c], q = t.ptr[c];
            while (p < s.ptr[c + 1] || q < t.ptr[c + 1]) {
                const std::int64_t row_p = p < s.ptr[c + 1] ? s.idx[p] : f_.n;
                const std::int64_t row_q = q < t.ptr[c + 1] ? t.idx[q] : f_.n;
                const std::int64_t row = std::min(row_p, row_q);
                compare(row, c, row_p == row ? s.val[p] : 0.0, row_q == row ? t.val[q] : 0.0);
                p += row_p == row, q += row_q == row;
            }
        }
    }

    /// By columns (or rows) that ascend, each entry next to its mirror image; false: not seen.
    bool is_symmetric_at_a_glance() const {
        if (!compressed() || f_.part != part::full) return false;
        double largest = 0, apart = 0;
        for (std::int64_t p = 0; p < f_.nnz; ++p) largest = std::max(largest, std::abs(value_[p]));
        return for_each_couple([&](std::int64_t p, std::int64_t q) {
                   apart = std::max(apart, std::abs(value_[p] - value_[q]));
               }) &&
               apart <= 1e-8 * largest;
    }

    const MatrixFormat &f_;
    const Index *a_, *b_;
    const double *value_;
};

} // namespace

template <class Index>
MatrixInput::MatrixInput(const MatrixFormat &f, const Index *a, const Index *b, const double *value)
    : layout(f), value_(value) {
    IndexArrays<Index> arrays;
    if (f.copy) {
        const std::int64_t n_a = f.storage == storage::triplets ? f.nnz : f.n + 1;
        arrays.own_a.assign(a, a + n_a);
        arrays.own_b.assign(b, b + f.nnz);
        own_value_.assign(value, value + f.nnz);
        arrays.a = arrays.own_a.data(), arrays.b = arrays.own_b.data(), value_ = own_value_.data();
    } else {
        arrays.a = a, arrays.b = b;
    }
    index_ = std::move(arrays); // a moved vector keeps its storage: the pointers stay right
}

template MatrixInput::MatrixInput(const MatrixFormat &, const std::int32_t *, const std::int32_t *,
                                  const double *);
template MatrixInput::MatrixInput(const MatrixFormat &, const std::int64_t *, const std::int64_t *,
                                  const double *);

void MatrixInput::check() const {
    std::visit([&](const auto &x) { Reader(layout, x.a, x.b, value_).check(); }, index_);
}

SparseMatrix MatrixInput::to_sparse() const {
    if (!layout.copy) check();
    return std::visit([&](const auto &x) { return Reader(layout, x.a, x.b, value_).mirrored(); }, index_);
}

} // namespace plm
