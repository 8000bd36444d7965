// Periodic motions of the exact flow as equations: x, the state at the beginning of the excitation's period,
// comes back after one period of the response. No harmonics are cut off; the tangent matrix is that of the
// monodromy, so the multipliers of a solution come with it.
#pragma once
#include "linalg/lapack.hpp"
#include "motions/periodic_equations.hpp"
#include "orbits/exact_flow.hpp"
#include "paths/residual.hpp"

namespace plm {

/// What a periodic motion is asked for at.
struct OrbitConditions {
    double omega = 0; // rad/s, of the excitation; the unknowns' scale where the path's parameter replaces it
    double force_scale = 1;
    std::int64_t period_multiple = 1;
    double tolerance = 0; // of a motion, relative; the flow is as exact, to rounding where that is small

    /// The flow that these conditions drive.
    ExactFlow flow(std::shared_ptr<const FlowModel> model, std::shared_ptr<ContactModesKept> modes) const;
};

class OrbitEquations final : public Residual {
  public:
    /// The path's parameter: the frequency (rad/s, of the excitation) or the force scale. Unknowns count from
    /// `rest`, displacements by the root of lambda + omega^2, so that |x|^2 is an energy. Structural damping
    /// depends on the frequency: such a model serves at one frequency only. modes: of the contact sets that
    /// others of that model have come by; null: of none.
    OrbitEquations(std::shared_ptr<const FlowModel> model, FlowState rest, const OrbitConditions &conditions,
                   FlowParameter parameter, std::shared_ptr<ContactModesKept> modes = nullptr);
    /// Others of the same model, which come by the same contact sets.
    OrbitEquations beside(const OrbitConditions &conditions, FlowParameter parameter) const;

    std::int64_t size() const override { return model_->state_size(); }
    void residual(const double *x, double p, double *r) override;
    void linearize() override;
    Tangent linearize_roughly() override;
    void solve(double *b, std::int64_t n) override;
    int determinant_sign() const override { return run_.lu.determinant_sign(); }
    void parameter_derivative(double *r) override;
    /// What rings for a moment must not dictate the steps.
    const vector<double> *weights() const override { return &share_; }
    double residual_scale() const override { return run_.size; }
    bool is_cheap_to_linearize() const override { return true; } // half a run of the flow, or one
    void remember() override { remembered_ = run_; }
    bool recall() override {
        if (remembered_.known) run_ = remembered_;
        return remembered_.known;
    }
    std::int64_t piece() const override { return static_cast<std::int64_t>(run_.intervals.size()); }

    /// As PeriodicEquations has them.
    EquationsMemory settle();
    void take(const EquationsMemory &memory);

    /// The one of frequency and force scale that is not the parameter, from the next residual() on.
    void set_other(double value);

    const FlowModel &model() const { return *model_; }
    const std::shared_ptr<const FlowModel> &shared_model() const { return model_; }
    FlowState state(const double *x) const;
    vector<double> unknowns(const FlowState &state) const;
    /// A derivative by the state as one by the unknowns.
    void to_unknowns(vector<double> &derivative) const;
    const std::shared_ptr<ContactModesKept> &modes() const { return modes_; }
    /// Of a value of the path's parameter.
    OrbitConditions conditions(double p) const;
    /// Of the last linearize(): d(state at the end) / d(state at the beginning), in the unknowns.
    const Matrix &monodromy() const { return run_.monodromy; }
    /// Its eigenvalues, the largest first; found once, whoever asks.
    const vector<std::complex<double>> &multipliers() const;
    /// The matrix of that linearize(): dR/dx.
    Matrix tangent() const;
    void solve_transposed(double *b) const { run_.lu.solve_transposed(b, 1, size()); }
    /// Of the tangent of the last linearize(): of the order of rounding where a motion is free to go
    /// anywhere.
    double reciprocal_condition() const { return run_.lu.reciprocal_condition(); }
    /// Contact of the last residual(), from the beginning of the period.
    const std::vector<ContactInterval> &intervals() const { return run_.intervals; }

  private:
    void run(const double *x, double p);
    bool is_small() const;
    void linearize_within(double tolerance);
    bool guess_monodromy();
    void factor_tangent();

    // A run from x to `end`, its change by the parameter, and what it was linearised to.
    struct Run {
        vector<double> x, end, change;
        double p = 0, size = 0;
        bool known = false, failed = false, overflown = false;
        std::vector<ContactInterval> intervals;
        Matrix monodromy;
        double monodromy_error = INFINITY; // what it was asked for within; infinite: not known, or guessed
        mutable vector<std::complex<double>> multipliers; // empty: not asked for yet
        RealLu lu;
    };

    std::shared_ptr<const FlowModel> model_;
    FlowState rest_;
    OrbitConditions conditions_;
    FlowParameter parameter_;
    std::shared_ptr<ContactModesKept> modes_;
    vector<double> weight_, share_; // of the unknowns
    Run run_, remembered_;
    EquationsMemory::Tangent before_, last_; // of the last two linearize(), where it takes long
    bool guessed_ = false;                   // since then
};

} // namespace plm
