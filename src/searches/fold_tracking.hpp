// The curve of folds of a response over (frequency, force). Where it turns back in the force, an isolated
// branch is born or joins another one: these are the ends of the range of forces in which the branch exists.
#pragma once
#include "hbm/branch.hpp"
#include "hbm/free_frequency.hpp"
#include "hbm/modal_factor.hpp"
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"

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

/// Corrects (x, omega) to a fold at the force scale given. False: `point` is unchanged.
bool correct_fold(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, double force,
                  BranchPoint &point);

struct FoldOptions {
    HbmOptions hbm;                      // with the tolerance and the steps of a curve
    double force_min = 0, force_max = 0; // range of force scales
    bool upward = true;                  // in the force, at the start
    bool stop_at_turn = false;           // at the first extremum of the force
};

/// Follows the folds from `fold` (a located one: PLM_BIFURCATION_FOLD), with its number of harmonics. Points
/// carry force scale and omega; those with PLM_BIFURCATION_FOLD are extrema of the force. Null when the start
/// cannot be corrected.
std::shared_ptr<Branch> follow_folds(std::shared_ptr<const ReducedModel> reduced, const FoldOptions &options,
                                     const BranchPoint &fold, Watch watch);

/// The same to both sides of the fold, as one curve: the side of smaller forces first, backwards. It ends for
/// the reason of the side that did not get to the end of the range, if any.
std::shared_ptr<Branch> follow_folds_both_ways(std::shared_ptr<const ReducedModel> reduced,
                                               FoldOptions options, const BranchPoint &fold, Watch watch);

} // namespace plm
