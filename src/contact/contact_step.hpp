// The contact forces of one implicit time step. With the flexibility W of the step's matrix at the contact
// (Z x Z) the forces N solve u = u_free - W N, N = max(k_n u, 0): the minimum of the convex, piecewise
// quadratic energy p^T W p / 2 + sum k_n max(u_free - W p, 0)^2 / 2, reached at p = N.
#pragma once
#include "contact/contact_law.hpp"
#include "contact/pair_states.hpp"
#include "linalg/lapack.hpp"

namespace plm {

class ContactStep {
  public:
    /// W symmetric positive semi-definite; the stiffness is borrowed.
    ContactStep(Matrix flexibility, const vector<double> &contact_stiffness);

    /// u_free (Z): penetration without contact forces. force (Z): a first guess on entry, N on return. Newton
    /// on the contact set with exact line search on the energy, which ends after finitely many steps.
    /// PLM_ERR_CONVERGENCE with PLM_REASON_CONTACT_CHATTER if rounding prevents that.
    void solve(const vector<double> &u_free, vector<double> &force);

    const vector<double> &penetration() const { return u_; } // of the last solve
    std::int64_t iterations() const { return iterations_; }  // all solves together
    std::int64_t factorizations() const { return factorizations_; }

  private:
    void factor_closed();
    bool settled(double noise) const;
    double line_search(const vector<double> &force) const;

    Matrix flexibility_, matrix_;
    const vector<double> &stiffness_;
    DenseCholesky cholesky_; // of 1 / k_n + W over the closed pairs
    PairStates states_, factored_;
    vector<std::int64_t> active_;
    vector<double> u_, direction_, change_, small_;
    std::int64_t iterations_ = 0, factorizations_ = 0;
};

} // namespace plm
