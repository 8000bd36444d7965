// Harmonic balance with more equations and as many more unknowns: the whole Jacobian is factored, so it does
// not matter that dR/dx alone is nearly singular at a resonance and singular at a fold.
#pragma once
#include "hbm/modal_factor.hpp"
#include "hbm/wrapped_system.hpp"

namespace plm {

class AugmentedSystem : public WrappedSystem {
  public:
    AugmentedSystem(HbmSystem &inner, std::int64_t n_more) : WrappedSystem(inner), n_more_(n_more) {}
    std::int64_t size() const override { return inner_.size() + n_more_; }
    void linearize() override {
        border_.reset(inner_.size(), n_more_);
        fill(border_);
        inner_.factor_bordered(border_, factor_);
    }
    void solve(double *b, std::int64_t n) override { factor_.solve(b, n); }
    int determinant_sign() const override { return factor_.determinant_sign(); }

  protected:
    /// The derivatives beside dR/dx at the last residual(); zeros at first.
    virtual void fill(Border &border) = 0;

  private:
    std::int64_t n_more_;
    Border border_;
    ModalFactor factor_;
};

} // namespace plm
