// Phase-resonant motions as equations of a path over the force.
#pragma once
#include "motions/free_frequency.hpp"

namespace plm {

/// R = 0 and no work in phase with the lowest harmonic of the excitation.
class PhaseSystem final : public FreeFrequency {
  public:
    using FreeFrequency::FreeFrequency;
    int determinant_sign() const override { return factor_->determinant_sign(); }

  private:
    double last_equation() override { return inner_.phase(); }
    bool linearize_all(double &by_force) override;
    void solve_linear(double *b, std::int64_t n) override { factor_->solve(b, n); }

    Border border_;
    std::unique_ptr<BorderedTangent> factor_;
};

} // namespace plm
