// The linear system of one contact set: K_i = diag(lambda) + G_A^T k_n G_A over the closed pairs A, and a
// bound of how fast its motions are. What the exact flow and its monodromy advance between two contact
// events.
#pragma once
#include "transient/flow_model.hpp"

namespace plm {

class ContactSet {
  public:
    explicit ContactSet(const FlowModel &model);

    /// Assembles K_i from the closed pairs (Z flags): always anew, since taking a stiff pair out again by
    /// subtraction would leave eps k_n behind. 2 |A| n^2 + 2 n^3 flops.
    void assign(const vector<char> &closed);
    const Matrix &stiffness() const { return stiffness_; } // n x n
    /// G_A^T k_n g_A: what the initial gaps of the closed pairs push with.
    const vector<double> &gap_force() const { return gap_force_; }
    /// Upper bound (1/s) of |A| for y' = A y with y = (rho q, q'), rho^2 = |K_i|: rho + |C| in the 2-norm.
    double rate() const { return rate_; }

  private:
    double spectral_bound(const Matrix &symmetric);

    const FlowModel &model_;
    double damping_bound_ = 0, rate_ = 0;
    Matrix rows_, stiffness_, square_;
    vector<double> gap_force_;
    vector<char> closed_;
    bool assigned_ = false;
};

/// Number of Taylor terms (powers 0 .. m - 1) after which exp(x) is known to `tolerance`: the remainder
/// x^m / m! / (1 - x / (m + 1)) is below it.
std::int64_t taylor_terms(double x, double tolerance);

} // namespace plm
