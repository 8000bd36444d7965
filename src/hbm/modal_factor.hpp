// Solves with the Jacobian of the harmonic balance in reduced coordinates, which may have rows and columns
// beside it: J itself is singular at a fold and nearly so at a resonance.
#pragma once
#include "hbm/modal_jacobian.hpp"
#include "hbm/receptance.hpp"
#include "motions/periodic_equations.hpp"

namespace plm {

/// With few pairs the contact forces y = T G x are the unknowns (Woodbury): of order n_acting (2H + 1) + k
/// instead of r (2H + 1) + k,
///     [I + T R, T G D^-1 B; -C D^-1 G', E - C D^-1 B] [y; s],    R = G D^-1 G',
/// and each solution is refined by its residual. Otherwise, and where D is singular, J is factored itself.
class ModalFactor final : public BorderedTangent {
  public:
    void factor(ModalJacobian &jacobian, const Border &border, bool may_condense = true);
    /// Overwrites n right-hand sides (leading dimension size()).
    void solve(double *b, std::int64_t n) override { solve(false, b, n); }
    void solve_transposed(double *b, std::int64_t n) override { solve(true, b, n); }
    std::int64_t size() const { return inner_size() + n_borders(); }
    /// The true sign, whichever way the matrix was factored.
    int determinant_sign() const override {
        return condensed_ ? sign_ * lu_.determinant_sign() : lu_.determinant_sign();
    }

  private:
    std::int64_t inner_size() const { return n_inner_; }
    std::int64_t n_borders() const { return border_.corner.rows(); }
    static std::int64_t n_forces(const ModalJacobian &jacobian) {
        return jacobian.n_acting() * jacobian.n_coefficients();
    }

    bool pays(const ModalJacobian &jacobian) const;
    bool invert_linear_part();
    bool condense();
    void add_contact_columns(std::int64_t h);
    void add_borders();
    void scale_borders();
    void factor_dense(ModalJacobian &jacobian);

    void apply_inverse(bool transposed, double *v); // D^-1 or D^-T
    void product(bool transposed, const double *x, double *y);
    void solve(bool transposed, double *b, std::int64_t n);
    bool solve_refined(bool transposed, double *b);
    void solve_once(double *b);
    void solve_once_transposed(double *b);

    ModalJacobian jacobian_; // while condensed
    Border border_;
    std::int64_t n_inner_ = 0;
    bool condensed_ = false;
    int sign_ = 1; // of det D
    std::vector<Receptance> receptance_;
    vector<double> scale_; // of the last k condensed equations
    Matrix matrix_;
    RealLu lu_;
    // of one call to the next: no iteration allocates
    Matrix real_, imaginary_, scaled_, gaps_, force_;
    vector<double> x_, change_, v_, forces_;
    vector<std::complex<double>> q_;
};

} // namespace plm
