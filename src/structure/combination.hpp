// Sums of the structure's matrices, as implicit time integration factors and applies them.
#pragma once
#include "structure/structure.hpp"

namespace plm {

/// mass M + stiffness K + damping C, C the explicit part.
struct MatrixWeights {
    double mass = 0, stiffness = 0, damping = 0;
};

class Combination {
  public:
    Combination(const Structure &structure, MatrixWeights coefficients);

    bool is_zero() const { return sum_.rows == 0; }
    /// y = A x, one column.
    void apply(const Field &x, Field &y) const {
        multiply_transposed(sum_, x.in_core().data(), y.in_core().data());
    }
    /// PLM_ERR_NOT_POSITIVE_DEFINITE where it is not.
    void factor();
    /// X becomes A^-1 X; after factor().
    void solve(Field &x) const { factor_->solve(x.in_core()); }

  private:
    void take(double factor, const SparseMatrix &a);

    SparseMatrix sum_; // 0 x 0: zero
    Solver solver_;
    std::unique_ptr<Factor> factor_;
};

} // namespace plm
