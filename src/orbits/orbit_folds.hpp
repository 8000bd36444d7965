// Folds of a curve of exact motions as equations of a path over the force.
#pragma once
#include "linalg/lapack.hpp"
#include "motions/periodic_equations.hpp"
#include "orbits/orbit_equations.hpp"

namespace plm {

/// Unknowns y = (x, (omega - omega of `about`) unit), parameter the force scale; equations R = 0 and g = 0
/// with g from M [v; g] = [0; 1], M = [J b; c^T 0] (minimally augmented, as FoldSystem). g's derivative is
/// -w^T (dJ) v, and second derivatives do not mind their order: it is the change along v of w^T J, w^T
/// dR/domega and w^T dR/dforce, one more run of the flow at a point beside the solution.
class OrbitFoldSystem final : public Residual {
  public:
    OrbitFoldSystem(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                    const BranchPoint &about);
    std::int64_t size() const override { return n_ + 1; }
    void residual(const double *y, double force, double *r) override;
    void linearize() override;
    void solve(double *b, std::int64_t n) override;
    int determinant_sign() const override { return lu_.determinant_sign(); }
    void parameter_derivative(double *r) override;
    const vector<double> *weights() const override { return &weight_; }
    double residual_scale() const override { return by_frequency_.residual_scale(); }
    bool is_cheap_to_linearize() const override { return true; } // longer steps pay for it
    std::int64_t piece() const override { return by_frequency_.piece(); }

    double omega_of(const double *y) const { return omega_ + y[n_] / unit_; }
    vector<double> unknowns(const BranchPoint &point, std::int64_t period_multiple) const;
    OrbitEquations &at_force(double force);

  private:
    /// Of R, at a state and the frequency and the force of the last residual().
    struct Derivatives {
        vector<double> by_frequency, by_force;
    };
    Derivatives derivatives_at(const vector<double> &x);
    void choose_borders();
    void find_null();

    OrbitEquations by_frequency_, by_force_;
    std::int64_t n_;
    double omega_, unit_ = 1;
    vector<double> weight_, right_, left_; // c and b
    // at the last residual()
    vector<double> x_, null_, left_null_; // null_: (v, g)
    double frequency_now_ = 0, force_now_ = 0;
    bool failed_ = false;
    Matrix tangent_;
    RealLu bordered_, lu_;
    vector<double> by_force_now_; // at the last linearize()
};

class OrbitFolds final : public PeriodicEquations {
  public:
    OrbitFolds(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
               const BranchPoint &about);
    Residual &residual() override { return system_; }
    vector<double> unknowns(const BranchPoint &point) const override;
    BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations) override;
    vector<std::complex<double>> multipliers(const BranchPoint &) override { return {}; }

  private:
    const MotionOptions options_;
    OrbitFoldSystem system_;
};

} // namespace plm
