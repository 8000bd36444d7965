#include "structure/solver/fronts.hpp"
#include "linalg/blas_lapack.hpp"
#include "linalg/parallel.hpp"
#include "linalg/work.hpp"
#include "structure/solver/factor.hpp"
#include <algorithm>

namespace plm {
namespace {

/// Columns eliminated at once, and rows below them that go through one matrix product: wide enough for the
/// speed of BLAS 3.
constexpr std::int64_t strip = 64, band = 512;

/// Columns of a Schur complement that are kept and updated together. What stands above the diagonal of such a
/// strip is computed and kept in vain.
constexpr std::int64_t schur_strip = 128;

/// The lower triangle of a Schur complement, strip by strip: each a dense block from its diagonal downwards.
struct SchurShape {
    std::int64_t size;

    std::int64_t rows_of(std::int64_t j) const { return size - j / schur_strip * schur_strip; }
    /// Where entry (i, j) stands, i >= the first column of j's strip.
    std::int64_t at(std::int64_t i, std::int64_t j) const {
        const std::int64_t s = j / schur_strip, first = s * schur_strip;
        return schur_strip * (s * size - schur_strip * (s * (s - 1) / 2)) + (i - first) +
               (j - first) * (size - first);
    }
    std::int64_t entries() const { return size == 0 ? 0 : at(size - 1, size - 1) + 1; }
};

/// One run over the supernodes without numbers: who is whose parent, and how high the stack grows.
struct Plan {
    Plan(std::int64_t n, const Supernodes &nodes) : parent(nodes.count, nodes.count) {
        vector<std::int64_t> node_of(n), stack;
        for (std::int64_t node = 0; node < nodes.count; ++node)
            for (std::int64_t j = nodes.first_column[node]; j < nodes.first_column[node + 1]; ++j)
                node_of[j] = node;
        const auto schur = [&](std::int64_t node) {
            return SchurShape{nodes.rows_of(node) - nodes.columns_of(node)}.entries();
        };
        std::int64_t height = 0;
        for (std::int64_t node = 0; node < nodes.count; ++node) {
            const std::int64_t own = schur(node), columns = nodes.columns_of(node);
            if (own > 0) parent[node] = node_of[nodes.row[nodes.first_row[node] + columns]];
            panel = std::max(panel, nodes.rows_of(node) * columns);
            panels += nodes.rows_of(node) * columns;
            widest = std::max(widest, columns);
            highest = std::max(highest, height + own);
            for (; !stack.empty() && parent[stack.back()] == node; stack.pop_back())
                height -= schur(stack.back());
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
    Fronts(const MatrixSum &a, const Supernodes &supernodes, PanelTaker *taker, double least_pivot)
        : a_(a), nodes_(supernodes), taker_(taker), least_pivot_(least_pivot), place_(a.a.cols),
          local_(a.a.cols), size_(a.a.cols, 0.0) {
        for (std::int64_t j = 0; j < a.a.cols; ++j) place_[nodes_.original[j]] = j;
        Plan plan(a.a.cols, supernodes);
        parent_ = std::move(plan.parent);
        if (!taker || !taker->room(0)) room_.resize(plan.panel);
        pivot_.resize(plan.widest);
        divided_.resize(strip * plan.widest);
        stack_entries_.resize(plan.highest);
    }

    std::int64_t count_negative() {
        for (std::int64_t node = 0; node < nodes_.count; ++node) eliminate(node);
        return negative_;
    }

  private:
    /// A Schur complement on the stack.
    struct Schur {
        std::int64_t node;
        SchurShape shape;
        double *entries;
    };

    void eliminate(std::int64_t node) {
        node_ = node;
        rows_ = nodes_.rows_of(node);
        columns_ = nodes_.columns_of(node);
        staying_ = {rows_ - columns_};
        row_ = nodes_.row + nodes_.first_row[node];
        panel_ = taker_ ? taker_->room(node) : nullptr;
        if (!panel_) panel_ = room_.data();
        assemble();
        for (std::int64_t first = 0; first < columns_; first += strip)
            eliminate_columns(first, std::min(strip, columns_ - first));
        update_schur();
        push();
        if (!taker_) return;
        divide_by_pivots();
        taker_->take(node, panel_, pivot_.data());
    }

    /// Leaves L where L D was: below the strip of each column.
    void divide_by_pivots() {
        for (std::int64_t k = 0; k < columns_; ++k) {
            double *column = panel_ + k * rows_;
            const double inverse = 1 / pivot_[k];
            for (std::int64_t i = std::min(columns_, k / strip * strip + strip); i < rows_; ++i)
                column[i] *= inverse;
        }
    }

    /// Of the front; columns that stay stand in the Schur complement to be.
    double *entry(std::int64_t i, std::int64_t j) {
        if (j < columns_) return panel_ + i + j * rows_;
        return schur_ + staying_.at(i - columns_, j - columns_);
    }

    void assemble() {
        schur_ = top();
        std::fill_n(panel_, rows_ * columns_, 0.0);
        std::fill_n(schur_, staying_.entries(), 0.0);
        for (std::int64_t i = 0; i < rows_; ++i) local_[row_[i]] = i;
        for (std::int64_t j = 0; j < columns_; ++j) {
            assemble_column(j, 1, a_.a);
            if (a_.b) assemble_column(j, a_.factor, *a_.b);
            size_[row_[j]] += std::fabs(*entry(j, j));
        }
        for (auto child = stack_.rbegin(); child != stack_.rend() && parent_[child->node] == node_; ++child)
            take_over(*child);
    }

    void assemble_column(std::int64_t j, double factor, const SparseMatrix &a) {
        const std::int64_t column = nodes_.original[row_[j]];
        for (std::int64_t p = a.ptr[column]; p < a.ptr[column + 1]; ++p) {
            const std::int64_t row = place_[a.idx[p]];
            if (row >= row_[j]) *entry(local_[row], j) += factor * a.val[p];
        }
    }

    /// Each column of the child has one of the front.
    void take_over(const Schur &child) {
        const std::int64_t below = child.shape.size, runs = (below + schur_strip - 1) / schur_strip;
        const std::int64_t *row = nodes_.row + nodes_.first_row[child.node + 1] - below;
        constexpr double flops_an_entry = 10; // it costs as much
        parallel_for(
            runs, flops_an_entry * static_cast<double>(child.shape.entries()), [&](std::int64_t run) {
                for (std::int64_t j = run * schur_strip; j < std::min(below, (run + 1) * schur_strip); ++j) {
                    const double *from = child.entries + child.shape.at(j, j);
                    const std::int64_t column = local_[row[j]];
                    double *to = entry(column, column); // the order of rows is that of the child
                    for (std::int64_t i = j; i < below; ++i) to[local_[row[i]] - column] += from[i - j];
                }
            });
    }

    double *top() {
        return stack_.empty() ? stack_entries_.data() : stack_.back().entries + stack_.back().shape.entries();
    }

    /// The Schur complement takes the place of those it was made from.
    void push() {
        while (!stack_.empty() && parent_[stack_.back().node] == node_) stack_.pop_back();
        if (staying_.size == 0) return;
        double *const place = top();
        if (place != schur_) std::copy_n(schur_, staying_.entries(), place); // downwards
        stack_.push_back({node_, staying_, place});
    }

    /// Afterwards these columns hold L D below the strip, and L of unit diagonal in it.
    void eliminate_columns(std::int64_t first, std::int64_t width) {
        const std::int64_t last = first + width, bands = (rows_ - last + band - 1) / band;
        divide(first, width, first, divided_);
        subtract_eliminated({first, width}, {first, width}, first, divided_, entry(first, first), rows_);
        for (std::int64_t k = first; k < last; ++k) eliminate_pivot(k, last);
        const double flops = static_cast<double>((rows_ - last) * width) * static_cast<double>(first + last);
        parallel_for(bands, flops, [&](std::int64_t run) {
            const std::int64_t begin = last + run * band, height = std::min(band, rows_ - begin);
            subtract_eliminated({begin, height}, {first, width}, first, divided_, entry(begin, first), rows_);
            eliminate_rows(begin, height, first, width);
        });
    }

    /// Some rows below a strip by its pivots.
    void eliminate_rows(std::int64_t begin, std::int64_t height, std::int64_t first, std::int64_t width) {
        const blas_int m = to_blas(height), n = to_blas(width), ld = leading(rows_);
        const double one = 1;
        dtrsm_("R", "L", "T", "U", &m, &n, &one, entry(first, first), &ld, entry(begin, first), &ld, 1, 1, 1,
               1);
        for (std::int64_t k = first; k < first + width; ++k) {
            const double *column = panel_ + k * rows_;
            const double scale = 1 / std::fabs(pivot_[k]);
            for (std::int64_t i = begin; i < begin + height; ++i)
                size_[row_[i]] += column[i] * column[i] * scale;
        }
        worked(in_products * static_cast<double>(height) * static_cast<double>(width * width));
    }

    /// Column k is done with; columns up to `last` are those of its strip.
    void eliminate_pivot(std::int64_t k, std::int64_t last) {
        double *column = panel_ + k * rows_;
        const double pivot = column[k];
        if (!(std::fabs(pivot) > least_pivot_ * size_[row_[k]])) // also NaN
            throw_singular(nodes_.original[row_[k]]);
        negative_ += pivot < 0;
        pivot_[k] = pivot;
        for (std::int64_t j = k + 1; j < last; ++j) {
            double *other = panel_ + j * rows_;
            const double factor = column[j] / pivot;
            size_[row_[j]] += std::fabs(column[j] * factor);
            for (std::int64_t i = j; i < last; ++i) other[i] -= column[i] * factor;
        }
        for (std::int64_t i = k + 1; i < last; ++i) column[i] /= pivot;
    }

    void update_schur() {
        const std::int64_t strips = (staying_.size + schur_strip - 1) / schur_strip;
        const double rows = static_cast<double>(staying_.size);
        parallel_for(strips, rows * rows * static_cast<double>(columns_), [&](std::int64_t s) {
            const std::int64_t first = columns_ + s * schur_strip,
                               width = std::min(schur_strip, rows_ - first);
            vector<double> divided(width * columns_);
            divide(first, width, columns_, divided);
            subtract_eliminated({first, rows_ - first}, {first, width}, columns_, divided,
                                entry(first, first), rows_ - first);
        });
    }

    /// L of some rows and the first `eliminated` columns, where L D stands.
    void divide(std::int64_t first, std::int64_t width, std::int64_t eliminated, vector<double> &l) const {
        const double *product = panel_ + first;
        for (std::int64_t k = 0; k < eliminated; ++k)
            for (std::int64_t i = 0; i < width; ++i) l[i + k * width] = product[i + k * rows_] / pivot_[k];
    }

    struct Range {
        std::int64_t first, count;
    };
    /// target -= L D L^T of the first `eliminated` columns, in some rows and columns; `divided`: L of these.
    void subtract_eliminated(Range rows, Range columns, std::int64_t eliminated,
                             const vector<double> &divided, double *target, std::int64_t ld_target) const {
        if (eliminated == 0) return;
        const blas_int m = to_blas(rows.count), n = to_blas(columns.count), inner = to_blas(eliminated);
        const blas_int ld = leading(rows_), ld_divided = leading(columns.count), ldc = leading(ld_target);
        const double minus = -1, one = 1;
        dgemm_("N", "T", &m, &n, &inner, &minus, panel_ + rows.first, &ld, divided.data(), &ld_divided, &one,
               target, &ldc, 1, 1);
        worked(in_products * 2.0 * m * n * inner);
    }

    const MatrixSum &a_;
    const Supernodes nodes_;
    PanelTaker *const taker_;
    const double least_pivot_;
    vector<std::int64_t> place_;          // new order of each row of A
    vector<std::int64_t> parent_, local_; // of a supernode; of a row (new order) in the front
    vector<double> size_;                 // |a_jj| + sum |l_jk|^2 |d_k| so far
    vector<double> room_, pivot_, divided_, stack_entries_; // room_: for the panel at work
    vector<Schur> stack_;
    std::int64_t negative_ = 0;

    // the front at work
    std::int64_t node_ = 0, rows_ = 0, columns_ = 0;
    SchurShape staying_{0};
    const std::int64_t *row_ = nullptr;
    double *panel_ = nullptr, *schur_ = nullptr;
};

} // namespace

std::int64_t eliminate_fronts(const MatrixSum &a, const Supernodes &supernodes, PanelTaker *taker,
                              double least_pivot) {
    return Fronts(a, supernodes, taker, least_pivot).count_negative();
}

FrontSizes front_sizes(std::int64_t n, const Supernodes &supernodes) {
    const Plan plan(n, supernodes);
    return {plan.panels, plan.panel + plan.highest + (strip + 2 * schur_strip) * plan.widest + 3 * n};
}

} // namespace plm
