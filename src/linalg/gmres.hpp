// Linear equations A x = b of which only products are known, by GMRES (Saad and Schultz 1986), preconditioned
// from the right: what is small at the end is the residual itself.
#pragma once
#include "dense.hpp"

namespace plm {

class LinearEquations {
  public:
    virtual ~LinearEquations() = default;
    /// y = A x
    virtual void product(const double *x, double *y) = 0;
    /// v becomes about A^-1 v.
    virtual void precondition(double *v) = 0;
};

class Gmres {
  public:
    /// Overwrites b (n) by A^-1 b, whose residual is below `tolerance` of b's norm. False, and b is kept: not
    /// reached in most_steps (no restarts).
    bool solve(LinearEquations &equations, std::int64_t n, double *b, double tolerance,
               std::int64_t most_steps);
    std::int64_t n_steps() const { return n_steps_; } // of the last solution
    /// Sign of the determinant of A times that of the preconditioner, as the last solution saw it: of the
    /// product of its Ritz values, among which those away from 1 settle first.
    int determinant_sign() const { return determinant_sign_; }

  private:
    void arnoldi_step(LinearEquations &equations, std::int64_t k);
    double rotate(std::int64_t k);
    void combine(LinearEquations &equations, std::int64_t k, double *x);

    Matrix basis_, hessenberg_;                  // orthonormal columns; upper triangular by rotations
    vector<double> cosine_, sine_, rhs_, image_; // of the rotations; of the least squares; P^-1 v
    std::int64_t n_steps_ = 0;
    int determinant_sign_ = 1;
};

} // namespace plm
