// A factor whose panels are kept in single precision, and whose solves are refined with the matrix in double
// until they are as good as those of a factor in double.
#pragma once
#include "structure/solver/factor.hpp"
#include "structure/solver/panel_factor.hpp"

namespace plm {

/// The lower triangle of a symmetric matrix, in half the memory.
struct HalfMatrix {
    explicit HalfMatrix(const SparseMatrix &a);
    std::int64_t size() const { return static_cast<std::int64_t>(first.size()) - 1; }
    vector<std::int64_t> first; // of each column, n + 1
    vector<std::int32_t> row;
    vector<double> value;
    vector<double> row_sum; // of |A|
};

class RefinedFactor final : public Factor {
  public:
    RefinedFactor(const SparseMatrix &a, const Supernodes &supernodes) : factor_(a, supernodes), matrix_(a) {}
    /// PLM_ERR_CONVERGENCE with PLM_REASON_NO_CONTRACTION where a right-hand side cannot be solved for in
    /// that way.
    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const override;
    double reciprocal_condition() const override { return factor_.reciprocal_condition(); }
    std::int64_t factor_nonzeros() const override { return factor_.nonzeros(); }

  private:
    PanelFactor<float> factor_;
    HalfMatrix matrix_;
};

} // namespace plm
