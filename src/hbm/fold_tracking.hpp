// The curve of folds of a response over (frequency, force). Where it turns back in the force, an isolated
// branch is born or joins another one: these are the ends of the range of forces in which the branch exists.
#pragma once
#include "hbm/augmented_system.hpp"
#include "linalg/monitor.hpp"

namespace plm {

/// y = (x, (omega - omega_reference) unit), parameter: the force scale. Equations R = 0 and g = 0, with g from
/// the bordered system [J b; c^T 0] [v; g] = [0; 1], which is regular at a fold (Griewank and Reddien 1984;
/// minimally augmented). Its derivative is -w^T (dJ) v: of the contact only the switching instants contribute.
/// `inner` has modal unknowns and the event-exact force.
class FoldSystem final : public AugmentedSystem {
  public:
    /// `about`: near a fold; b and c are taken from the null vectors there.
    FoldSystem(HbmSystem &inner, std::shared_ptr<const ReducedModel> reduced, const BranchPoint &about, double unit);
    void residual(const double *y, double force, double *r) override;
    void omega_derivative(double *r) override;
    void linear_response(const vector<double> &share, double force, double *y) override;
    void to_point(const double *y, double force, BranchPoint &point) override;
    void from_point(const BranchPoint &point, double *y) override;

  protected:
    void assemble(Matrix &jacobian) override;

  private:
    double omega_of(const double *y) const { return omega_reference_ + y[inner_.size()] / unit_; }
    void bordered(bool transposed, vector<double> &solution);
    void choose_borders(const BranchPoint &about);
    vector<double> frequency_derivative(const vector<double> &v);
    void contact_gradient(const vector<double> &w, const vector<double> &v, double *gradient);
    Matrix penetration(const double *x, bool weights) const;

    std::shared_ptr<const ReducedModel> reduced_;
    double omega_reference_, unit_;
    vector<double> b_, c_, y_, scratch_;
    double force_ = 0;
    Matrix jacobian_, matrix_;
    RealLu lu_;
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

} // namespace plm
