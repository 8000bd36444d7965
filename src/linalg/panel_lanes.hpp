// Products and triangular solves with the panels of a factor, for a few right-hand sides: these stand side by
// side in the lanes of the processor's vectors, so that every entry of L is read once for all of them, and a
// row of them is found in one place. (A call of BLAS packs the panel first, as much work as eight right-hand
// sides make.)
#pragma once
#include "linalg/lanes.hpp"
#include "linalg/memory.hpp"

namespace plm {

/// Right-hand sides to a group: a row of a group is 64 bytes. The last group is padded with zeros.
template <class T> constexpr std::int64_t side_by_side = 64 / sizeof(T);
template <class T> constexpr std::int64_t groups_of(std::int64_t nrhs) {
    return (nrhs + side_by_side<T> - 1) / side_by_side<T>;
}

/// Rows of right-hand sides, of which the groups are `stride` entries apart.
template <class T> struct LaneRows {
    T *entries;
    std::int64_t stride, groups;
    T *group(std::int64_t g) const { return entries + g * stride; }
    LaneRows from(std::int64_t row) const { return {entries + row * side_by_side<T>, stride, groups}; }
    operator LaneRows<const T>() const { return {entries, stride, groups}; }
};

/// A block of right-hand sides with storage of its own.
template <class T> class LaneBlock {
  public:
    LaneBlock() = default;
    LaneBlock(std::int64_t rows, std::int64_t nrhs)
        : rows_(rows), nrhs_(nrhs), entries_(groups_of<T>(nrhs) * stride(), T(0)) {}
    std::int64_t rows() const { return rows_; }
    std::int64_t columns() const { return nrhs_; }
    T &operator()(std::int64_t row, std::int64_t j) { return entries_[place(row, j)]; }
    T operator()(std::int64_t row, std::int64_t j) const { return entries_[place(row, j)]; }
    bool empty() const { return entries_.empty(); }
    std::int64_t stride() const { return rows_ * side_by_side<T>; }
    std::int64_t groups() const { return groups_of<T>(nrhs_); }
    LaneRows<T> all() { return {entries_.data(), stride(), groups()}; }
    LaneRows<const T> all() const { return {entries_.data(), stride(), groups()}; }

  private:
    std::int64_t place(std::int64_t row, std::int64_t j) const {
        return j / side_by_side<T> * stride() + row * side_by_side<T> + j % side_by_side<T>;
    }
    std::int64_t rows_ = 0, nrhs_ = 0;
    vector<T> entries_;
};

/// X becomes L^-1 X or L^-T X. L: n x n, unit lower triangular, columns ld apart; what is above its diagonal
/// is not read.
template <class T>
void solve_lower(std::int64_t n, const T *l, std::int64_t ld, const LaneRows<T> &x,
                 bool wide = has_wide_lanes());
template <class T>
void solve_lower_transposed(std::int64_t n, const T *l, std::int64_t ld, const LaneRows<T> &x,
                            bool wide = has_wide_lanes());

/// Y += sign L X, L: rows x n; anew: Y becomes that, and n > 0.
template <class T>
void multiply_panel(std::int64_t rows, std::int64_t n, const T *l, std::int64_t ld,
                    const LaneRows<const T> &x, T sign, bool anew, const LaneRows<T> &y,
                    bool wide = has_wide_lanes());
/// Y -= L^T X, L: rows x n.
template <class T>
void subtract_panel_transposed(std::int64_t rows, std::int64_t n, const T *l, std::int64_t ld,
                               const LaneRows<const T> &x, const LaneRows<T> &y,
                               bool wide = has_wide_lanes());

} // namespace plm
