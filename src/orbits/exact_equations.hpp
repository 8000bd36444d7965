// Exact motions as periodic equations.
#pragma once
#include "motions/options.hpp"
#include "motions/periodic_equations.hpp"
#include "orbits/orbit_equations.hpp"

namespace plm {

class ExactEquations final : public PeriodicEquations {
  public:
    /// omega: a frequency near by, at which the unknowns are measured and the flow's model is made. known: an
    /// exact motion whose contact sets are taken over if it is of the same model, or null.
    ExactEquations(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options, double omega,
                   const BranchPoint *known = nullptr);
    OrbitEquations &orbits() { return orbits_; }

    std::int64_t size() const override { return orbits_.size(); }
    void residual(const double *x, double omega, double *r) override;
    void linearize() override { orbits_.linearize(); }
    Tangent linearize_roughly() override { return orbits_.linearize_roughly(); }
    void solve(double *b, std::int64_t n) override { orbits_.solve(b, n); }
    int determinant_sign() const override { return orbits_.determinant_sign(); }
    void parameter_derivative(double *r) override { orbits_.parameter_derivative(r); }
    const vector<double> *weights() const override { return orbits_.weights(); }
    double residual_scale() const override { return orbits_.residual_scale(); }
    bool is_cheap_to_linearize() const override { return orbits_.is_cheap_to_linearize(); }
    void remember() override { orbits_.remember(); }
    bool recall() override { return orbits_.recall(); }
    std::int64_t piece() const override { return orbits_.piece(); }

    /// The force alone: a flow has the stiffness of its model.
    void set(PathParameter parameter, double value) override;
    /// One more run of the flow.
    void derivative(PathParameter parameter, double *r) override;
    vector<double> unknowns(const BranchPoint &point) const override;
    BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations) override;
    /// By marching: to a stable motion, where there is one.
    bool find(double omega, Watch watch, vector<double> &x, NewtonWork &work) override;
    EquationsMemory settle() override { return orbits_.settle(); }
    void take(const EquationsMemory &memory) override { orbits_.take(memory); }
    bool has_multipliers() const override { return options_.stability != StabilityKind::off; }
    vector<std::complex<double>> multipliers(const vector<double> &, double) override {
        return orbits_.multipliers();
    }
    void factor_bordered(const Border &border, std::unique_ptr<BorderedTangent> &out) override;
    double row_size(double) const override { return 1; }
    /// Second derivatives do not mind their order: the change along v of w^T J, w^T dR/domega and w^T
    /// dR/dforce, by more runs of the flow at a point beside the solution.
    MotionGradient tangent_change(const vector<double> &w, const vector<double> &v) override;
    /// Mean over the period of load(t) . y. Its derivative by x is exact, those by the frequency and the
    /// force are differences.
    double phase() override;
    bool phase_gradient(MotionGradient &gradient) override;

  private:
    /// Of R, at the last residual().
    struct Derivatives {
        Matrix by_unknowns;
        vector<double> by_frequency, by_force;
    };
    Derivatives derivatives();
    double work(double omega, double force) const;
    /// Of the harmonic that drives, at the frequency.
    HarmonicLoad load(double omega) const { return load_at(orbits_.model().excitation(), harmonic_, omega); }

    MotionOptions options_; // with the force of now
    OrbitEquations orbits_, by_force_;
    double phase_size_ = 1;
    int harmonic_ = 0;            // of the excitation; 0: nothing is driven
    vector<double> x_;            // of the last residual()
    double omega_ = 0, work_ = 0; // the latter: of the last phase()
};

} // namespace plm
