// The linear system of one contact set: K_i = diag(lambda) + G_A^T S G_A with the springs S of its pairs
// (contact/piece_contact.hpp), and a bound of how fast its motions are. What the exact flow and its monodromy
// advance between two contact events.
#pragma once
#include "contact/piece_contact.hpp"
#include "orbits/flow_model.hpp"

namespace plm {

class ContactSet {
  public:
    explicit ContactSet(const FlowModel &model);

    /// Assembles K_i. 2 |A| n^2 + 2 n^3 flops, few of them where a pair or two have changed.
    void assign(const PairStates &states);
    /// Of the set with the fastest motions: every pair's spring acts.
    void assign_stiffest() { assign(PairStates::all_closed(model_.n_pairs())); }
    const Matrix &stiffness() const { return stiffness_; } // n_moving x n_moving
    /// Upper bound (1/s) of |A| for y' = A y with y = (rho q, q'), rho^2 = |K_i|: rho + |C| in the 2-norm.
    double rate() const { return rate_; }
    /// |C|, part of it.
    double damping_bound() const { return damping_bound_; }

    /// u (Z x k) as it would be without contact forces becomes the penetration; the forces, Z x k.
    void add_contact(Matrix &u, Matrix &force) const { contact_.add_forces(u, force); }

    /// What relaxes, at order k of a Taylor series in time / dt: y_k from K y_(k-1) and the y_k of what has
    /// mass. force: its coefficients of order k - 1, or null. All vectors n_moving; only those entries of
    /// next change.
    void relax(std::int64_t k, double dt, const double *before, const double *force, double *next) const;

  private:
    double spectral_bound(const Matrix &symmetric);
    bool raise_rate();
    void find_rate(const PairStates &states);

    const FlowModel &model_;
    std::int64_t moving_, massive_;
    double damping_bound_ = 0, rate_ = 0;
    double bound_ = 0; // of |K_i| for the states bounded_
    PairStates bounded_;
    int age_ = 0; // sets since
    PieceContact contact_;
    Matrix stiffness_, square_, fourth_, relaxing_; // relaxing_: columns of K_i, as rows, of what relaxes
};

/// Number of Taylor terms (powers 0 .. m - 1) after which exp(x) is known to `tolerance`: the remainder
/// x^m / m! / (1 - x / (m + 1)) is below it.
std::int64_t taylor_terms(double x, double tolerance);

} // namespace plm
