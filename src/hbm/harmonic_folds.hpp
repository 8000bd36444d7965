// Folds of a response curve of harmonic balance as equations of a path over the force.
#pragma once
#include "hbm/free_frequency.hpp"
#include "hbm/modal_factor.hpp"
#include "hbm/options.hpp"
#include "motions/periodic_equations.hpp"

namespace plm {

/// Equations R = 0 and g = 0, with g from the bordered system M [v; g] = [0; 1], M = [J b; c^T 0], which is
/// regular at a fold (Griewank and Reddien 1984; minimally augmented). Its derivative is -w^T (dJ) v: of the
/// contact only the switching instants contribute. One factorization, of M, serves g, its derivative and
/// Newton's corrections. `inner` has modal unknowns and the event-exact force.
class FoldSystem final : public FreeFrequency<WrappedSystem> {
  public:
    /// `about`: near a fold; b and c are taken from the null vectors there.
    FoldSystem(HbmSystem &inner, std::shared_ptr<const ReducedModel> reduced, const BranchPoint &about,
               double unit);
    void residual(const double *y, double force, double *r) override;
    void linearize() override;
    void solve(double *b, std::int64_t n) override;
    int determinant_sign() const override;

  private:
    void factor_matrix();
    void choose_borders(const BranchPoint &about);
    vector<double> frequency_derivative(const vector<double> &v);
    vector<double> contact_gradient(const vector<double> &w, const vector<double> &v) const;
    Matrix gap_motion(const vector<double> &x, double factor) const;

    std::shared_ptr<const ReducedModel> reduced_;
    Border border_; // b and c
    // at the last residual()
    vector<double> y_, v_; // v_: (v, g)
    ModalFactor bordered_;
    bool fresh_ = false; // bordered_ has not moved to linear_ yet
    // at the last linearize()
    ModalFactor linear_;
    vector<double> null_, frequency_, gradient_; // (v, g); (z, zeta) = -M^-1 (dR/dy_omega, 0); dg/dy
    double determinant_ = 1;                     // of the two scalar equations left
    vector<double> scratch_;
};

/// With the harmonics of `about`, near a fold.
class HarmonicFolds final : public PeriodicEquations {
  public:
    HarmonicFolds(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                  const BranchPoint &about);
    Residual &residual() override { return *system_; }
    vector<double> unknowns(const BranchPoint &point) const override;
    BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations) override;
    vector<std::complex<double>> multipliers(const BranchPoint &) override { return {}; }

  private:
    std::unique_ptr<HbmSystem> inner_;
    std::unique_ptr<FoldSystem> system_;
};

} // namespace plm
