// Rigid-body motion that neither supports nor contact hold: of a structure in free flight, on rails, or
// beside stops that its motion does not reach. It changes no gap that closes, so that periodic motion under
// balanced loads leaves its mean position open: zero here.
#pragma once
#include "contact/contact_force.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

/// Its directions in the static coordinates, orthonormal: r_0 x n. holding: Z flags of the pairs that act
/// at some time; without it all pairs hold.
Matrix free_motion(const ReducedModel &reduced);
Matrix free_motion(const ReducedModel &reduced, const vector<char> &holding);

/// S (r_0 x n) so that S S^T, added to the static stiffness, holds the mean position while the pairs touch as
/// the indicator of the last set() says. Any stiffness does, since no load acts along it; this one is that of
/// the softest static coordinate. Directions along which the mean of the loads acts are not held: no periodic
/// motion exists there.
class MeanHold {
  public:
    MeanHold() = default;
    explicit MeanHold(const ReducedModel &reduced);
    /// mean_load: r_0. True: columns() are others than before.
    bool set(const ReducedModel &reduced, const ContactIndicator &indicator, const double *mean_load);
    const Matrix &columns() const { return columns_; }
    /// Whether the mean of the loads acts along a motion that no acting pair holds: no periodic one is here,
    /// however small a residual is beside the distance that has been gone.
    bool carried_away() const { return depends_ && pushed_; }
    /// Whether columns() may ever change with the indicator.
    bool depends_on_contact() const { return depends_; }

  private:
    void assign(const ReducedModel &reduced, Matrix directions);

    Matrix always_, directions_, columns_; // what no pair holds; what no acting pair holds; S
    vector<char> holding_, now_;
    bool depends_ = false, pushed_ = false;
};

/// Throws PLM_ERR_CONVERGENCE with PLM_REASON_NO_EQUILIBRIUM when the mean of the loads drives a motion that
/// no pair could hold: no periodic one exists.
void require_balanced(const ReducedModel &reduced);

/// What to look at where no periodic motion was found and contact alone could hold the structure; else empty.
std::string drift_hint(const ReducedModel &reduced);

} // namespace plm
