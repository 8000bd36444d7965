// A response curve: points of Fourier coefficients in reduced coordinates, and what an engineer reads from
// them.
#pragma once
#include "reduction/reduced_model.hpp"

namespace plm {

/// Coordinates of one point: static part (r_0) and cosine/sine parts (r x 2H), all a caller can ask follows
/// from it.
struct BranchPoint {
    double omega = 0;             // rad/s
    vector<double> eta_0;         // r_0
    Matrix eta;                   // r x 2H: columns a1, b1, a2, b2, ...
    double arclength = 0;         // scaled, from the branch's first point
    double residual = 0;          // relative residual reached
    std::int64_t iterations = 0;  // Newton iterations spent
    std::int64_t n_switching = 0; // pairs that open and close in the period
};

enum class Measure {
    peak = PLM_PEAK,
    half_peak_to_peak = PLM_HALF_PEAK_TO_PEAK,
    rms = PLM_RMS,
    harmonic = PLM_HARMONIC
};

class Branch {
  public:
    Branch(std::shared_ptr<const ReducedModel> reduced, std::int64_t n_harmonics, double force_scale)
        : reduced_(std::move(reduced)), n_harmonics_(n_harmonics), force_scale_(force_scale) {}

    void append(BranchPoint point) { points_.push_back(std::move(point)); }
    const std::vector<BranchPoint> &points() const { return points_; }
    const ReducedModel &reduced() const { return *reduced_; }
    const std::shared_ptr<const ReducedModel> &reduced_model() const { return reduced_; }
    std::int64_t n_harmonics() const { return n_harmonics_; }
    double force_scale() const { return force_scale_; }

    // how it ended and what it cost
    std::int32_t end_reason = PLM_REASON_NONE; // PLM_REASON_...
    std::int64_t newton_iterations = 0, failed_steps = 0, factorizations = 0;
    double seconds = 0, seconds_per_iteration = 0;
    std::string space_used; // "modal" or "gaps"

    /// (2H + 1) coefficients a0, a1, b1, ... of a full-model DOF (base 0; zeros when fixed) at a point.
    vector<double> coefficients(std::int64_t point, std::int64_t dof) const;
    double amplitude(std::int64_t point, std::int64_t dof, Measure measure, std::int64_t harmonic) const;
    /// q over all n_dof at t = fraction x period.
    vector<double> field(std::int64_t point, double fraction) const;
    /// Penetration coefficients (2H + 1) x Z, the gap included in a0.
    Matrix penetration_coefficients(std::int64_t point) const;
    /// Share of the period during which each pair is closed, from the exact switching instants.
    vector<double> closed_share(std::int64_t point) const;
    /// Relative residual of the full-order harmonic-balance equations; see plm_branch_get_full_residual.
    double full_residual(std::int64_t point) const;

  private:
    std::shared_ptr<const ReducedModel> reduced_;
    std::int64_t n_harmonics_;
    double force_scale_;
    std::vector<BranchPoint> points_;
};

} // namespace plm
