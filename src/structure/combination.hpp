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

    bool is_zero() const { return !sum_; }
    /// Y = A X, both of one column.
    void apply(const Field &x, Field &y) const { sum_->times(x, y); }
    /// PLM_ERR_NOT_POSITIVE_DEFINITE where it is not.
    void factor() { factor_ = sum_->factor(solver_); }
    /// X becomes A^-1 X; after factor().
    void solve(Field &x) const { factor_->solve(x); }

  private:
    void take(double factor, const TallMatrix &a);

    std::unique_ptr<TallMatrix> sum_; // null: zero
    Solver solver_;
    std::unique_ptr<TallFactor> factor_;
};

} // namespace plm
