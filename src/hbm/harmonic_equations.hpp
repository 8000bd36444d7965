// Harmonic balance as periodic equations.
#pragma once
#include "hbm/options.hpp"
#include "hbm/system.hpp"
#include "motions/periodic_equations.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

class HarmonicEquations final : public PeriodicEquations {
  public:
    /// omega: a frequency near by. multipliers: null where none are wanted. What stands beside the tangent
    /// (folds, phase resonance) asks for reduced coordinates.
    HarmonicEquations(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, double omega,
                      MultipliersOf multipliers = nullptr);
    HbmSystem &system() { return *system_; }

    std::int64_t size() const override { return system_->size(); }
    std::int64_t static_size() const override { return system_->static_size(); }
    void residual(const double *x, double omega, double *r) override;
    void linearize() override { system_->linearize(); }
    void solve(double *b, std::int64_t n) override { system_->solve(b, n); }
    int determinant_sign() const override { return system_->determinant_sign(); }
    void parameter_derivative(double *r) override { system_->parameter_derivative(r); }
    double residual_scale() const override { return system_->residual_scale(); }
    bool in_balance() const override { return system_->in_balance(); }
    std::int64_t piece() const override { return system_->piece(); }

    void set(PathParameter parameter, double value) override;
    void derivative(PathParameter parameter, double *r) override;
    vector<double> unknowns(const BranchPoint &point) const override;
    BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations) override;
    bool find(double omega, Watch watch, vector<double> &x, NewtonWork &work) override;
    /// They begin anew, and keep nothing.
    EquationsMemory settle() override;
    void take(const EquationsMemory &memory) override;
    bool has_multipliers() const override { return multipliers_ != nullptr; }
    /// Those of the last point asked for are kept: tests and records come in turn.
    vector<std::complex<double>> multipliers(const vector<double> &x, double omega) override;
    void factor_bordered(const Border &border, std::unique_ptr<BorderedTangent> &out) override;
    double row_size(double omega) const override { return omega * omega; }
    /// Of the contact only the switching instants contribute. The event-exact force alone.
    MotionGradient tangent_change(const vector<double> &w, const vector<double> &v) override;
    double phase() override;
    bool phase_gradient(MotionGradient &gradient) override;

  private:
    vector<double> frequency_derivative(const vector<double> &v);
    Matrix contact_change(const vector<double> &w, const vector<double> &v) const;
    Matrix gap_motion(const double *x, double factor) const;
    vector<double> phase_row(bool changed) const;

    std::shared_ptr<const ReducedModel> reduced_;
    HbmOptions options_;
    double reference_;
    std::unique_ptr<HbmSystem> system_;
    MultipliersOf multipliers_;
    vector<double> x_; // of the last residual()
    double omega_ = 0;
    vector<double> known_x_;
    double known_omega_ = -1;
    vector<std::complex<double>> known_multipliers_;
};

} // namespace plm
