// L D L^T of a positive definite matrix with the columns of L rounded to single precision front by front,
// while they are computed in double: half the memory, and far nearer to A than a factorization in single
// precision.
#pragma once
#include "structure/solver/fronts.hpp"

namespace plm {

class PanelFactor final : PanelTaker {
  public:
    /// PLM_ERR_NOT_POSITIVE_DEFINITE with index() = column where `a` is not. The supernodes are copied.
    PanelFactor(const SparseMatrix &a, const Supernodes &supernodes);
    PanelFactor(const PanelFactor &) = delete;

    /// Right-hand sides at once: enough for the speed of BLAS 3.
    static constexpr std::int64_t widest_solve = 64;
    /// X becomes about A^-1 X, to single precision; X is n x nrhs with leading dimension n, nrhs <=
    /// widest_solve.
    void solve(double *x, std::int64_t nrhs) const;
    double reciprocal_condition() const { return reciprocal_condition_; }
    std::int64_t nonzeros() const { return nonzeros_; }

  private:
    void take(std::int64_t node, const double *panel, const double *pivots) override;
    void forward(std::int64_t nrhs) const;
    void divide_by_pivots(std::int64_t nrhs) const;
    void backward(std::int64_t nrhs) const;
    Supernodes nodes() const {
        return {static_cast<std::int64_t>(first_column_.size()) - 1, first_column_.data(), first_row_.data(),
                row_.data(), original_.data()};
    }

    std::int64_t n_, nonzeros_ = 0;
    vector<std::int64_t> first_column_, first_row_, row_, original_;
    vector<std::int64_t> first_entry_; // of each supernode's panel
    vector<float> panels_;
    vector<double> pivots_;
    double largest_pivot_ = 1, reciprocal_condition_ = 1;
    mutable vector<float> work_,
        rows_below_; // n x nrhs in the new order; what one panel reads or adds below it
};

} // namespace plm
