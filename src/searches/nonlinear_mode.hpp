// Nonlinear modes by the extended periodic motion concept (Krack 2015): periodic motions without excitation,
// M q'' + C q' + K q + B^T N = P + 2 xi omega M q', where the negative damping makes up for what C
// dissipates: xi is the mode's damping ratio. Frequency and damping over the amplitude; the pre-load stays.
#pragma once
#include "hbm/augmented_system.hpp"
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"
#include "motions/motion_measures.hpp"

namespace plm {

/// y = (static part / largest amplitude, dynamic part / amplitude, omega / omega_reference - 1, xi),
/// parameter: the logarithm of the amplitude. The shape psi normalises: psi . M a_1 = amplitude, psi . M b_1
/// = 0.
class NonlinearModeSystem final : public AugmentedSystem {
  public:
    NonlinearModeSystem(HbmSystem &inner, const ReducedModel &reduced, vector<double> shape,
                        double omega_reference, double largest_amplitude);
    void residual(const double *y, double log_amplitude, double *r) override;
    void parameter_derivative(double *r) override;
    double residual_scale() const override;
    void solve(double *b, std::int64_t n) override;
    void to_point(const double *y, double log_amplitude, BranchPoint &point) override;
    void from_point(const BranchPoint &point, double *y) override;

  protected:
    void fill(Border &border) override;

  private:
    double omega() const { return omega_reference_ * (1 + y_[inner_.size()]); }
    void unscale(const double *y, double amplitude, double *x) const;
    void add_self_excitation(const double *x, double factor, double *r) const;

    std::int64_t r_, n_with_mass_; // those without mass come last
    vector<double> shape_;         // M psi: nothing without mass has a share in the amplitude
    double omega_reference_, largest_;
    vector<double> y_, x_; // at the last residual()
    double amplitude_ = 1, factored_amplitude_ = 1;
};

struct NonlinearModeOptions {
    HbmOptions hbm; // harmonics (0: as many as the largest motion needs), tolerance, steps; its frequency
                    // range and force scale are not used
    std::int64_t mode = 0; // 1, 2, ...: elastic modes about rest; 0: the nearest to frequency_hz
    double frequency_hz = 0;
    std::int64_t dof = -1; // the path ends where its first harmonic reaches dof_amplitude_max; -1: see below
    double dof_amplitude_max = 0;
    // psi . M a_1 with psi of unit modal mass (sqrt(mass) x length). 0: from half the amplitude at which the
    // first pair changes its state to a hundred times as much; needs pre-load or gap
    double amplitude_min = 0, amplitude_max = 0;
};

/// One entry per point of the branch; its points have force scale 0.
struct NonlinearMode {
    std::shared_ptr<Branch> branch;
    vector<double> amplitude;
    std::vector<MotionMeasures> measures;
};

/// Throws PLM_ERR_CONVERGENCE when no motion is found at the smallest amplitude.
NonlinearMode follow_nonlinear_mode(std::shared_ptr<const ReducedModel> reduced,
                                    const NonlinearModeOptions &options, Watch watch);

} // namespace plm
