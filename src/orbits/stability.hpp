// Stability of periodic responses: Floquet multipliers of the exact motion beside the solution, and what
// their passage of the unit circle means.
#pragma once
#include "motions/options.hpp"
#include "motions/periodic_equations.hpp"
#include "orbits/exact_motion.hpp"
#include "orbits/monodromy.hpp"

namespace plm {

/// What multipliers are found for: left to the library, they are on a curve of a small model, and at one
/// point of any.
enum class StabilityOf { curve, point };

class Stability final : public PointMultipliers {
  public:
    Stability(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
              StabilityOf of = StabilityOf::curve);
    /// Whether the options and the size of the model ask for multipliers.
    bool wanted() const { return wanted_; }
    /// Of the perturbations over one period of the response, largest first: 2 n, n the coordinates of the
    /// flow. Empty: no exact motion was found beside the point. Structural damping counts as viscous damping
    /// that loses the same energy at the response frequency.
    vector<std::complex<double>> multipliers(const BranchPoint &point) override;
    vector<double> settle() override { return beside_.settle(); }
    void take(const vector<double> &known) override { beside_.take(known); }
    /// What is said with points that have no multipliers.
    std::string unknown_text(std::int64_t n_unknown, std::int64_t n_points) const;

  private:
    std::shared_ptr<const ReducedModel> reduced_;
    MotionBeside beside_;
    std::int64_t period_multiple_;
    bool wanted_, hill_;
    std::shared_ptr<const FlowModel> flow_; // null when it depends on the frequency
};

} // namespace plm
