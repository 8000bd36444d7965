// Nonlinear modes as equations: motions without excitation, which negative damping keeps up.
#pragma once
#include "hbm/modal_factor.hpp"
#include "hbm/wrapped_system.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

/// y = (static part / largest amplitude, dynamic part / amplitude, omega / omega_reference - 1, xi),
/// parameter: the logarithm of the amplitude. The shape psi normalises: psi . M a_1 = amplitude, psi . M b_1
/// = 0. The whole Jacobian is factored, so it does not matter that dR/dx alone is singular.
class NonlinearModeSystem final : public WrappedSystem {
  public:
    NonlinearModeSystem(HbmSystem &inner, const ReducedModel &reduced, vector<double> shape,
                        double omega_reference, double largest_amplitude);
    std::int64_t size() const override { return inner_.size() + 2; }
    void residual(const double *y, double log_amplitude, double *r) override;
    void linearize() override;
    int determinant_sign() const override { return factor_.determinant_sign(); }
    void parameter_derivative(double *r) override;
    double residual_scale() const override;
    void solve(double *b, std::int64_t n) override;
    void to_point(const double *y, double log_amplitude, BranchPoint &point) override;
    void from_point(const BranchPoint &point, double *y) override;

  private:
    double omega() const { return omega_reference_ * (1 + y_[inner_.size()]); }
    void unscale(const double *y, double amplitude, double *x) const;
    void add_self_excitation(const double *x, double factor, double *r) const;

    std::int64_t r_, n_with_mass_; // those without mass come last
    vector<double> shape_;         // M psi: nothing without mass has a share in the amplitude
    double omega_reference_, largest_;
    vector<double> y_, x_; // at the last residual()
    double amplitude_ = 1, factored_amplitude_ = 1;
    Border border_;
    ModalFactor factor_;
};

} // namespace plm
