// Folds of a response curve as equations of a path over the force.
#pragma once
#include "motions/free_frequency.hpp"

namespace plm {

/// R = 0 and g = 0, with g from the bordered system M [v; g] = [0; 1], M = [J b; c^T 0], which is regular at
/// a fold (Griewank and Reddien 1984; minimally augmented). Its derivative is -w^T (dJ) v. One factorization,
/// of M, serves g, its derivative and Newton's corrections.
class FoldSystem final : public FreeFrequency {
  public:
    /// `about`: near a fold; b and c are taken from the null vectors there.
    FoldSystem(PeriodicEquations &inner, const BranchPoint &about);
    int determinant_sign() const override;
    bool is_cheap_to_linearize() const override { return inner_.is_cheap_to_linearize(); }

  private:
    double last_equation() override;
    bool linearize_all(double &by_force) override;
    void solve_linear(double *b, std::int64_t n) override;
    void choose_borders(const BranchPoint &about);

    Border border_; // b and c
    // at the last residual()
    vector<double> v_; // (v, g)
    std::unique_ptr<BorderedTangent> bordered_;
    // at the last linearize()
    std::unique_ptr<BorderedTangent> linear_;
    vector<double> null_, frequency_, gradient_; // (v, g); (z, zeta) = -M^-1 (dR/dy_omega, 0); dg/dy
    double determinant_ = 1;                     // of the two scalar equations left
};

} // namespace plm
