// L D L^T of a positive definite matrix with the columns of L kept as dense panels, in double precision or
// rounded to single front by front, while they are computed in double: half the memory then, and far nearer
// to A than a factorization in single precision.
#pragma once
#include "linalg/panel_lanes.hpp"
#include "structure/solver/fronts.hpp"

namespace plm {

/// T: double or float. Factorization and solves are shared out among threads (linalg/parallel.hpp), and
/// threads may solve at once.
template <class T> class PanelFactor final : PanelTaker {
  public:
    /// PLM_ERR_NOT_POSITIVE_DEFINITE with index() = column where `a` is not. The supernodes are copied.
    PanelFactor(const SparseMatrix &a, const Supernodes &supernodes);
    PanelFactor(const PanelFactor &) = delete;

    /// Right-hand sides at once: more are hardly faster.
    static constexpr std::int64_t widest_solve = 64;
    /// X becomes A^-1 X, to the precision of T; X is n x nrhs with leading dimension ldx, nrhs <=
    /// widest_solve.
    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const;
    double reciprocal_condition() const { return reciprocal_condition_; }
    std::int64_t nonzeros() const { return nonzeros_; }

  private:
    friend class ResponseProducts;
    /// A subtree of the supernodes, solved for by one thread. What it adds to rows above it waits in a block
    /// of its own.
    struct Subtree {
        std::int64_t first, last; // supernodes first .. last; the last one is its root
    };
    double *room(std::int64_t node) override;
    void take(std::int64_t node, const double *panel, const double *pivots) override;
    void allocate_panels();
    void choose_subtrees();
    void locate_outside_rows(const Subtree &subtree);
    vector<std::int64_t> parents() const;

    /// Where rows of right-hand sides in the new order stand: one after the other from `offset` on, or each
    /// in its place.
    template <class Entry> struct RowsOf {
        LaneRows<Entry> all;
        std::int64_t offset;
        const std::int64_t *place;
        LaneRows<Entry> from(std::int64_t row) const { return all.from(place ? place[row] : row - offset); }
        Entry *at(std::int64_t row, std::int64_t group) const { return from(row).group(group); }
        operator RowsOf<const Entry>() const { return {all, offset, place}; }
    };
    using Rows = RowsOf<T>;
    using KnownRows = RowsOf<const T>;
    void solve_in_order(const LaneRows<T> &all, double scale_of_pivots) const;
    /// above: what it adds to the rows below its root.
    void forward_subtree(const Subtree &subtree, const Rows &x, LaneBlock<T> &above) const;
    void backward_subtree(const Subtree &subtree, const Rows &x, const KnownRows &above) const;
    /// from_subtrees: empty where one adds nothing.
    void forward_rest(const std::vector<LaneBlock<T>> &from_subtrees, const Rows &x) const;
    void backward_rest(const Rows &x) const;
    void forward_own(std::int64_t node, const Rows &x, const LaneRows<T> &sums) const;
    void backward_node(std::int64_t node, const Rows &x, const KnownRows &above,
                       const LaneRows<T> &known) const;
    void divide(std::int64_t first, std::int64_t last, const Rows &x, double scale) const;
    std::int64_t most_below(const Subtree &subtree) const;

    Supernodes nodes() const {
        return {static_cast<std::int64_t>(first_column_.size()) - 1, first_column_.data(), first_row_.data(),
                row_.data(), original_.data()};
    }
    std::int64_t below(std::int64_t node) const { return nodes().rows_of(node) - nodes().columns_of(node); }
    const std::int64_t *rows_below(std::int64_t node) const {
        return row_.data() + first_row_[node] + nodes().columns_of(node);
    }

    std::int64_t n_, nonzeros_ = 0, most_below_ = 0;
    vector<std::int64_t> first_column_, first_row_, row_, original_;
    vector<std::int64_t> first_entry_; // of each supernode's panel
    vector<Subtree> subtrees_;         // independent ones, ascending
    vector<std::int64_t> rest_;        // supernodes above them, ascending
    // of each supernode of a subtree: how many of the rows below it are in the subtree; of the others, the
    // place among the rows below the root, and where these places begin
    vector<std::int64_t> inside_, first_place_, place_;
    vector<T> panels_;
    vector<double> pivots_;
    double largest_pivot_ = 1, reciprocal_condition_ = 1;
};

} // namespace plm
