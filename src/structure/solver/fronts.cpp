#include "structure/solver/fronts.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/work.hpp"
#include "structure/solver/factor.hpp"
#include <algorithm>
#include <limits>

namespace plm {
namespace {

/// Columns eliminated, and columns of a Schur complement updated, by one matrix product: wide enough for the
/// speed of BLAS 3; what a product computes above the diagonal is in vain.
constexpr std::int64_t strip = 64;

/// The computed pivots are those of A + E exactly, where E_jj is some roundings of the sum
/// |a_jj| + sum |l_jk|^2 |d_k| that pivot j was subtracted from (Higham, Accuracy and Stability of Numerical
/// Algorithms, theorem 10.3, holds for D of any signs). Of a thousand terms they add up to about the root of
/// their number, 32: a smaller pivot may have either sign.
constexpr double noise = 32 * std::numeric_limits<double>::epsilon();

/// One run over the supernodes without numbers: who is whose parent, and how high the stack grows.
struct Plan {
    Plan(std::int64_t n, const Supernodes &nodes) : parent(nodes.count, nodes.count) {
        vector<std::int64_t> node_of(n), stack;
        for (std::int64_t node = 0; node < nodes.count; ++node)
            for (std::int64_t j = nodes.first_column[node]; j < nodes.first_column[node + 1]; ++j)
                node_of[j] = node;
        const auto below = [&](std::int64_t node) { return nodes.rows_of(node) - nodes.columns_of(node); };
        std::int64_t height = 0;
        for (std::int64_t node = 0; node < nodes.count; ++node) {
            const std::int64_t own = below(node) * below(node), columns = nodes.columns_of(node);
            if (own > 0) parent[node] = node_of[nodes.row[nodes.first_row[node] + columns]];
            panel = std::max(panel, nodes.rows_of(node) * columns);
            panels += nodes.rows_of(node) * columns;
            widest = std::max(widest, columns);
            highest = std::max(highest, height + own);
            for (; !stack.empty() && parent[stack.back()] == node; stack.pop_back())
                height -= below(stack.back()) * below(stack.back());
            if (own == 0) continue;
            stack.push_back(node);
            height += own;
        }
        require(stack.empty(), "eliminate_fronts: the supernodes are in no postorder");
    }

    vector<std::int64_t> parent; // a root's: nobody
    std::int64_t panel = 0, panels = 0, widest = 0, highest = 0;
};

class Fronts {
  public:
    Fronts(const SparseMatrix &a, const Supernodes &supernodes, PanelTaker *taker)
        : a_(a), nodes_(supernodes), taker_(taker), place_(a.cols), local_(a.cols), size_(a.cols, 0.0) {
        for (std::int64_t j = 0; j < a.cols; ++j) place_[nodes_.original[j]] = j;
        Plan plan(a.cols, supernodes);
        parent_ = std::move(plan.parent);
        panel_.resize(plan.panel);
        pivot_.resize(plan.widest);
        divided_.resize(strip * plan.widest);
        stack_entries_.resize(plan.highest);
    }

    std::int64_t count_negative() {
        for (std::int64_t node = 0; node < nodes_.count; ++node) eliminate(node);
        return negative_;
    }

  private:
    /// A Schur complement on the stack, below x below; only its lower triangle means anything.
    struct Schur {
        std::int64_t node, below;
        double *entries;
    };

    void eliminate(std::int64_t node) {
        node_ = node;
        rows_ = nodes_.rows_of(node);
        columns_ = nodes_.columns_of(node);
        row_ = nodes_.row + nodes_.first_row[node];
        assemble();
        for (std::int64_t first = 0; first < columns_; first += strip)
            eliminate_columns(first, std::min(strip, columns_ - first));
        for (std::int64_t first = columns_; first < rows_; first += strip)
            subtract_eliminated(first, std::min(strip, rows_ - first), columns_, entry(first, first),
                                rows_ - columns_);
        push();
        if (!taker_) return;
        divide_by_pivots();
        taker_->take(node, panel_.data(), pivot_.data());
    }

    /// Leaves L where L D was: below the strip of each column.
    void divide_by_pivots() {
        for (std::int64_t k = 0; k < columns_; ++k) {
            double *column = panel_.data() + k * rows_;
            const double inverse = 1 / pivot_[k];
            for (std::int64_t i = std::min(columns_, k / strip * strip + strip); i < rows_; ++i)
                column[i] *= inverse;
        }
    }

    /// Of the front; columns that stay stand in the Schur complement to be.
    double *entry(std::int64_t i, std::int64_t j) {
        if (j < columns_) return panel_.data() + i + j * rows_;
        return schur_ + (i - columns_) + (j - columns_) * (rows_ - columns_);
    }

    void assemble() {
        const std::int64_t staying = rows_ - columns_;
        schur_ = top();
        std::fill_n(panel_.data(), rows_ * columns_, 0.0);
        std::fill_n(schur_, staying * staying, 0.0);
        for (std::int64_t i = 0; i < rows_; ++i) local_[row_[i]] = i;
        for (std::int64_t j = 0; j < columns_; ++j) {
            const std::int64_t column = nodes_.original[row_[j]];
            for (std::int64_t p = a_.ptr[column]; p < a_.ptr[column + 1]; ++p) {
                const std::int64_t row = place_[a_.idx[p]];
                if (row < row_[j]) continue;
                *entry(local_[row], j) = a_.val[p];
                if (row == row_[j]) size_[row] += std::fabs(a_.val[p]);
            }
        }
        for (auto child = stack_.rbegin(); child != stack_.rend() && parent_[child->node] == node_; ++child)
            take_over(*child);
    }

    void take_over(const Schur &child) {
        const std::int64_t *row = nodes_.row + nodes_.first_row[child.node + 1] - child.below;
        for (std::int64_t j = 0; j < child.below; ++j) {
            const double *from = child.entries + j * child.below;
            const std::int64_t column = local_[row[j]];
            double *to = entry(column, column); // the order of rows is that of the child
            for (std::int64_t i = j; i < child.below; ++i) to[local_[row[i]] - column] += from[i];
        }
    }

    double *top() {
        return stack_.empty() ? stack_entries_.data()
                              : stack_.back().entries + stack_.back().below * stack_.back().below;
    }

    /// The Schur complement takes the place of those it was made from.
    void push() {
        while (!stack_.empty() && parent_[stack_.back().node] == node_) stack_.pop_back();
        const std::int64_t staying = rows_ - columns_;
        if (staying == 0) return;
        double *const place = top();
        if (place != schur_) std::copy_n(schur_, staying * staying, place); // downwards
        stack_.push_back({node_, staying, place});
    }

    /// Afterwards these columns hold L D below the strip, and L of unit diagonal in it.
    void eliminate_columns(std::int64_t first, std::int64_t width) {
        subtract_eliminated(first, width, first, entry(first, first), rows_);
        for (std::int64_t k = first; k < first + width; ++k) eliminate_pivot(k, first + width);
        const std::int64_t last = first + width, rest = rows_ - last;
        if (rest == 0) return;
        const blas_int m = to_blas(rest), n = to_blas(width), ld = leading(rows_);
        const double one = 1;
        dtrsm_("R", "L", "T", "U", &m, &n, &one, entry(first, first), &ld,
               panel_.data() + last + first * rows_, &ld, 1, 1, 1, 1);
        for (std::int64_t k = first; k < last; ++k) {
            const double *column = panel_.data() + k * rows_;
            const double scale = 1 / std::fabs(pivot_[k]);
            for (std::int64_t i = last; i < rows_; ++i) size_[row_[i]] += column[i] * column[i] * scale;
        }
        worked(static_cast<double>(rest) * static_cast<double>(width * width));
    }

    /// Column k is done with; columns up to `last` are those of its strip.
    void eliminate_pivot(std::int64_t k, std::int64_t last) {
        double *column = panel_.data() + k * rows_;
        const double pivot = column[k];
        if (!(std::fabs(pivot) > noise * size_[row_[k]])) // also NaN
            throw_singular(nodes_.original[row_[k]]);
        negative_ += pivot < 0;
        pivot_[k] = pivot;
        for (std::int64_t j = k + 1; j < last; ++j) {
            double *other = panel_.data() + j * rows_;
            const double factor = column[j] / pivot;
            size_[row_[j]] += std::fabs(column[j] * factor);
            for (std::int64_t i = j; i < last; ++i) other[i] -= column[i] * factor;
        }
        for (std::int64_t i = k + 1; i < last; ++i) column[i] /= pivot;
    }

    /// target -= L D L^T of the first `eliminated` columns, in the rows from `first` on and `width` columns.
    void subtract_eliminated(std::int64_t first, std::int64_t width, std::int64_t eliminated, double *target,
                             std::int64_t ld_target) {
        if (eliminated == 0) return;
        const double *product = panel_.data() + first; // L D
        for (std::int64_t k = 0; k < eliminated; ++k)
            for (std::int64_t i = 0; i < width; ++i)
                divided_[i + k * width] = product[i + k * rows_] / pivot_[k];
        const blas_int m = to_blas(rows_ - first), n = to_blas(width), inner = to_blas(eliminated);
        const blas_int ld = leading(rows_), ld_divided = leading(width), ldc = leading(ld_target);
        const double minus = -1, one = 1;
        dgemm_("N", "T", &m, &n, &inner, &minus, product, &ld, divided_.data(), &ld_divided, &one, target,
               &ldc, 1, 1);
        worked(2.0 * m * n * inner);
    }

    const SparseMatrix &a_;
    const Supernodes nodes_;
    PanelTaker *const taker_;
    vector<std::int64_t> place_;          // new order of each row of A
    vector<std::int64_t> parent_, local_; // of a supernode; of a row (new order) in the front
    vector<double> size_;                 // |a_jj| + sum |l_jk|^2 |d_k| so far
    vector<double> panel_, pivot_, divided_, stack_entries_;
    vector<Schur> stack_;
    std::int64_t negative_ = 0;

    // the front at work
    std::int64_t node_ = 0, rows_ = 0, columns_ = 0;
    const std::int64_t *row_ = nullptr;
    double *schur_ = nullptr;
};

} // namespace

std::int64_t eliminate_fronts(const SparseMatrix &a, const Supernodes &supernodes, PanelTaker *taker) {
    return Fronts(a, supernodes, taker).count_negative();
}

FrontSizes front_sizes(std::int64_t n, const Supernodes &supernodes) {
    const Plan plan(n, supernodes);
    return {plan.panels, plan.panel + plan.highest + (strip + 1) * plan.widest + 3 * n};
}

} // namespace plm
