// Phase-resonant exact motions as equations of a path over the force.
#pragma once
#include "motions/periodic_equations.hpp"
#include "orbits/orbit_equations.hpp"

namespace plm {

/// Unknowns y = (x, (omega - omega of `about`) unit), parameter the force scale; equations R = 0 and no work
/// in phase with the excitation's lowest harmonic, whose load is `load` (of the flow's coordinates): the
/// integral of load(t) . y over the period. Its derivative by x is exact, those by the frequency and the
/// force are differences.
class OrbitPhaseSystem final : public Residual {
  public:
    /// A change of omega over the whole range of the options counts as much as the response at their force.
    OrbitPhaseSystem(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                     const BranchPoint &about);
    std::int64_t size() const override { return n_ + 1; }
    void residual(const double *y, double force, double *r) override;
    void linearize() override;
    void solve(double *b, std::int64_t n) override;
    int determinant_sign() const override { return lu_.determinant_sign(); }
    void parameter_derivative(double *r) override;
    const vector<double> *weights() const override { return &weight_; }
    double residual_scale() const override { return by_frequency_.residual_scale(); }
    std::int64_t piece() const override { return by_frequency_.piece(); }

    double scale() const { return scale_; }
    double omega_of(const double *y) const { return omega_ + y[n_] / unit_; }
    vector<double> unknowns(const BranchPoint &point) const;
    OrbitEquations &at_force(double force);

  private:
    double work(double omega, double force) const; // from x_
    void take_unit(const MotionOptions &options, const BranchPoint &about);

    OrbitEquations by_frequency_, by_force_;
    std::int64_t n_, period_multiple_;
    int harmonic_ = 0; // of the excitation; 0: nothing is driven
    const HarmonicLoad *load_ = nullptr;
    double omega_, unit_ = 1, scale_ = 1, row_scale_ = 1;
    vector<double> weight_;
    // at the last residual()
    vector<double> x_;
    double frequency_now_ = 0, force_now_ = 0, work_ = 0;
    bool failed_ = false;
    RealLu lu_;
    vector<double> by_force_now_; // at the last linearize()
};

class OrbitPhase final : public PeriodicEquations {
  public:
    OrbitPhase(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
               const BranchPoint &about)
        : options_(options), system_(std::move(reduced), options, about) {}
    Residual &residual() override { return system_; }
    vector<double> unknowns(const BranchPoint &point) const override { return system_.unknowns(point); }
    BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations) override;
    vector<std::complex<double>> multipliers(const BranchPoint &point) override;
    double scale() const { return system_.scale(); }

  private:
    const MotionOptions options_;
    OrbitPhaseSystem system_;
};

} // namespace plm
