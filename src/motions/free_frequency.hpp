// Periodic equations with the frequency as their last unknown, one equation more, and another
// parameter: y = (x, (omega - omega_reference) unit).
#pragma once
#include "motions/periodic_equations.hpp"

namespace plm {

class FreeFrequency : public Residual {
  public:
    FreeFrequency(PeriodicEquations &inner, double omega_reference, double unit,
                  PathParameter parameter = PathParameter::force);

    std::int64_t size() const final { return n_ + 1; }
    std::int64_t static_size() const final { return inner_.static_size(); }
    const vector<double> *weights() const final { return weights_.empty() ? nullptr : &weights_; }
    double residual_scale() const final { return inner_.residual_scale(); }
    bool in_balance() const final { return inner_.in_balance(); }
    std::int64_t piece() const final { return inner_.piece(); }
    void residual(const double *y, double p, double *r) final;
    void linearize() final;
    void solve(double *b, std::int64_t n) final;
    /// At the last linearize().
    void parameter_derivative(double *r) final;

    double omega_of(const double *y) const { return reference_ + y[n_] / unit_; }
    vector<double> unknowns(const BranchPoint &point) const;
    BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations);

  protected:
    /// The equation more, at the last residual() of the others.
    virtual double last_equation() = 0;
    /// For solve_linear(); false: there is nothing to correct by. by_force: what the last equation changes
    /// by.
    virtual bool linearize_all(double &by_force) = 0;
    virtual void solve_linear(double *b, std::int64_t n) = 0;

    PeriodicEquations &inner_;
    const std::int64_t n_;
    const double unit_;
    vector<double> x_; // at the last residual()
    double omega_ = 0;

  private:
    const double reference_;
    const PathParameter parameter_;
    vector<double> weights_, by_force_;
    bool failed_ = false, stands_ = false; // the equations are where they were evaluated last
};

} // namespace plm
