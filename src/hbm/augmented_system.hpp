// Harmonic balance with more equations and as many more unknowns: the whole Jacobian is factored, so it does
// not matter that dR/dx alone is nearly singular at a resonance and singular at a fold.
#pragma once
#include "hbm/wrapped_system.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>

namespace plm {

class AugmentedSystem : public WrappedSystem {
  public:
    AugmentedSystem(HbmSystem &inner, std::int64_t n_more) : WrappedSystem(inner), n_more_(n_more) {}
    std::int64_t size() const override { return inner_.size() + n_more_; }
    void linearize() override {
        assemble(matrix_);
        lu_.factor(matrix_);
    }
    void solve(double *b, std::int64_t n) override { lu_.solve(b, n, size()); }
    int determinant_sign() const override { return lu_.determinant_sign(); }

  protected:
    /// The size() x size() Jacobian at the last residual().
    virtual void assemble(Matrix &jacobian) = 0;

    /// `jacobian` with dR/dx in place and zeros beside it.
    void assemble_inner(Matrix &jacobian) {
        inner_.jacobian(inner_jacobian_);
        const std::int64_t n = inner_.size();
        jacobian.reset(size(), size());
        for (std::int64_t j = 0; j < n; ++j)
            std::copy(inner_jacobian_.col(j), inner_jacobian_.col(j) + n, jacobian.col(j));
    }

  private:
    std::int64_t n_more_;
    Matrix matrix_, inner_jacobian_;
    RealLu lu_;
};

} // namespace plm
