// The exponential of the linear system [0 I; -K -C] of a contact set, applied to matrices: what the monodromy
// is a product of.
#pragma once
#include "orbits/contact_set.hpp"

namespace plm {

/// [Y; V] of n + m rows, n displacements of which the first m have mass and a velocity, in the precision of
/// Real. By Chebyshev's series (Tal-Ezer and Kosloff, J. Chem. Phys. 81, 1984), phi_{k+1} = 2 A phi_k +
/// phi_{k-1}: one n x n by n x (n + m) product a term, two when C is not diagonal, that is 4 n^3 (8 n^3)
/// flops, and as many terms as the fastest motion turns by radians, and some. In double precision the
/// exponential of a long piece is squared together. What has no mass relaxes (ContactSet::relax) from term to
/// term of Taylor's series, T_{k+2} = -dt^2 / ((k + 1)(k + 2)) K T_k - dt / (k + 2) C T_{k+1}, in double
/// precision only.
template <class Real> class PieceExponential {
  public:
    /// tolerance: of the truncation, over one piece.
    PieceExponential(const FlowModel &model, double tolerance);

    void set_identity();
    void set(const Matrix &m);
    void get(Matrix &m) const;
    /// Products of 4 n^3 flops (with diagonal damping) that a piece takes where nothing relaxes.
    static double n_products(const ContactSet &set, double dt, double tolerance);
    /// [Y; V] becomes exp(A dt) [Y; V]. PLM_ERR_CONVERGENCE where the phase of the fastest motion is lost.
    void apply(const PairStates &states, double dt);

  private:
    /// Columns of displacements and of velocities, the latter n long too, in zeros beyond the m-th.
    struct Block {
        vector<Real> y, v;
    };

    bool relaxes() const { return n_ > massive_; }
    void scale_by(double time);
    void square(double x, double dt);
    void sum(Block &block, double x, double dt, double tolerance);
    void sum_chebyshev(Block &block, double x, double dt, double tolerance);
    void add_acceleration(double factor, const Block &of, vector<Real> &to);
    void sum_taylor(Block &block, double dt, std::int64_t n_terms);
    void next_taylor_term(std::int64_t k, double dt);
    void relax(std::int64_t k, double dt, const vector<Real> &before, vector<Real> &next) const;
    void join(const Block &block, vector<Real> &m) const;
    void split(const vector<Real> &m, Block &block) const;
    void make_identity(Block &block) const;
    double cube() const;

    const FlowModel &model_;
    ContactSet system_;
    std::int64_t n_, massive_, size_;
    double tolerance_;
    Block block_, step_;
    Block older_, newer_;              // the last two terms, or the last three of Taylor's
    vector<Real> stiffness_, damping_; // scaled
    vector<Real> whole_, turned_, square_;
};

extern template class PieceExponential<float>;
extern template class PieceExponential<double>;

} // namespace plm
