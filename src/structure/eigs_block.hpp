// Private to structure: a block of tall columns made M-orthonormal, to those of a basis and among themselves.
#pragma once
#include "structure/field.hpp"

namespace plm {

/// Works by BLAS 3, one product with M for all columns. Columns that the others and the basis contain but for
/// rounding are dropped: the block ends narrower, or empty.
class LanczosBlock {
  public:
    Field x, mx; // the columns, and M times them once they are M-orthonormal

    /// X = V taken + Y rest, where the columns of Y, M-orthonormal and M-orthogonal to V, become the block.
    /// `before`: squared M-norm of what the caller has taken from each column already.
    void orthonormalize(const TallMatrix &m, const Field &v, const vector<double> &before);

    std::int64_t width() const { return x.cols(); }
    const Matrix &taken() const { return taken_; } // columns of V x columns there were
    const Matrix &rest() const { return rest_; }   // columns left x columns there were

  private:
    void project(const TallMatrix &m, const Field &v);
    void drop_noise();
    void factor_gram();
    void divide_by_factor();
    void swap_columns(std::int64_t a, std::int64_t b);
    void put_in_order();
    void keep_where(const vector<double> &value, double above);

    vector<std::int64_t> order_; // of the columns, as the small matrices have it: theirs follows
    Matrix gram_, taken_, rest_;
    vector<double> origin_;         // squared M-norm of each column there was
    vector<double> entered_, left_; // that of each column before this pass, and the part of it that is left
};

} // namespace plm
