// The contact on one piece of a piecewise-linear flow, where every pair keeps its state: linear springs S
// along the gap rows G, k_n in series with what follows the pairs at once (without mass and damping), that is
// (1/k_n + F_A)^-1 over the closed pairs A with the flexibility F, of any stiffness down to none.
#pragma once
#include "contact/contact.hpp"
#include "linalg/lapack.hpp"

namespace plm {

class PieceContact {
  public:
    /// All are borrowed. gap: Z x n, of which the first n_moving columns count here; flexibility: Z x Z, or
    /// empty where nothing follows.
    PieceContact(const Contact &contact, const Matrix &gap, const Matrix &flexibility, std::int64_t n_moving);

    /// stiffness: G_A^T S G_A (n_moving x n_moving); no pair is taken out by subtraction, which would leave
    /// eps k_n behind. False, and it stays as it is, where these are the present states. PLM_ERR_SINGULAR
    /// when F_A is not positive definite. A change of few pairs costs (Z / 8 + 4) n^2 flops where nothing
    /// follows and n is at most 256, else 2 |A| n^2.
    bool assign(const PairStates &states, Matrix &stiffness);

    /// Bound of how far G_A^T S G_A is above that of other states, in the 2-norm, where nothing follows: the
    /// springs that act now and do not there.
    double growth_since(const PairStates &other) const;

    /// u (Z x k) as it would be without contact forces becomes the penetration; the forces, Z x k.
    void add_forces(Matrix &u, Matrix &force) const;

  private:
    void sum_springs(const PairStates &states, Matrix &stiffness);
    void sum_group(std::int64_t group, const PairStates &states);
    void find_stiffness(Matrix &stiffness);

    const Contact &contact_;
    const Matrix &gap_, &flexibility_;
    std::int64_t moving_;
    PairStates states_;
    vector<std::int64_t> active_;
    Matrix rows_, sprung_;     // sprung_: sqrt(k_n) G, by pair
    std::vector<Matrix> sums_; // of groups of pairs, and of two such sums, up to all at 1: a binary tree
    vector<char> changed_;     // which of them
    DenseCholesky cholesky_;   // of 1/k_n + F_A
    vector<double> norms_;     // k_n |g|^2 of each pair
    bool assigned_ = false;
};

} // namespace plm
