// A response curve: points of Fourier coefficients in reduced coordinates, and what an engineer reads from
// them.
#pragma once
#include "linalg/warnings.hpp"
#include "motions/branch_point.hpp"
#include "paths/newton.hpp"
#include "reduction/reduced_model.hpp"
#include <cmath>
#include <string>

namespace plm {

enum class Measure { peak = 1, half_peak_to_peak = 2, rms = 3, harmonic = 4 }; // as in plm.h

/// Whose amplitude is asked for.
struct Output {
    std::int64_t dof = 0; // base 0; or one of the sums of DOFs (Structure::n_outputs())
    Measure measure = Measure::half_peak_to_peak;
    std::int64_t harmonic = 0; // of Measure::harmonic
};

/// How a branch ended (PLM_REASON_...), in words; `sampled`: its contact forces came from time samples.
std::string end_text(std::int32_t reason, bool sampled = false);

/// Amplitude of the motion a0, a1, b1, ..., aH, bH; harmonic is used by Measure::harmonic only, those beyond
/// H are zero.
double amplitude_of(const vector<double> &coefficient, Measure measure, std::int64_t harmonic);
/// From its extrema: the peak or half peak to peak.
double amplitude_of(const ValueRange &range, Measure measure);

/// A number that is linear in the motion, such as a DOF: what each column of P and of P_0 makes of it.
struct DofInBasis {
    vector<double> of_dynamic, of_static; // r, r_0
};

struct SweepRecord; // curve_progress.hpp

class Branch {
  public:
    Branch(std::shared_ptr<const ReducedModel> reduced, double force_scale, std::int64_t period_multiple = 1)
        : reduced_(std::move(reduced)), force_scale_(force_scale), period_multiple_(period_multiple) {}

    /// Points may differ in their number of harmonics; all are padded with zeros to the largest.
    void append(BranchPoint point);
    /// Puts the points of `piece`, which leads away from the first point (and begins with it), before it: the
    /// curve then runs from the far end of the piece on.
    void prepend(const Branch &piece);
    /// Adds the points of `piece`, which leads on from the last point (and begins with it).
    void continue_with(const Branch &piece);
    /// Takes back the points from `count` on.
    void truncate(std::int64_t count) { points_.resize(static_cast<std::size_t>(count)); }
    const std::vector<BranchPoint> &points() const { return points_; }
    /// Of all points' multipliers.
    void set_multiplier_error(double error) {
        for (BranchPoint &p : points_) p.multiplier_error = error;
    }
    const ReducedModel &reduced() const { return *reduced_; }
    const std::shared_ptr<const ReducedModel> &reduced_model() const { return reduced_; }
    std::int64_t n_harmonics() const { return n_harmonics_; }
    double force_scale() const { return force_scale_; }
    /// Periods of the excitation in one period of the response; harmonics count from the latter.
    std::int64_t period_multiple() const { return period_multiple_; }

    // how it ended and what it cost
    std::int32_t end_reason = reason::none; // PLM_REASON_...
    NewtonWork newton_work;
    std::int64_t failed_steps = 0;
    double seconds = 0; // of the whole run
    double seconds_per_iteration() const {
        return newton_work.iterations > 0 ? newton_work.seconds / static_cast<double>(newton_work.iterations)
                                          : 0;
    }
    std::string unknowns_used; // "modal", "gaps", "both" or "state"
    bool sampled = false;      // contact forces from time samples
    Warnings warnings;         // what should be looked at before its points are used
    double model_error = NAN;  // what a larger model changed of its highest motion, relative; NaN: not known
    bool is_mode = false;      // a nonlinear mode: motions without excitation, each with a damping ratio
    std::shared_ptr<const SweepRecord> record; // what its sweep goes on from where it was stopped; or null
    std::shared_ptr<const Branch> beside;      // a closed curve that its sweep came upon first; or null

    // dof: of the full model, base 0, or an output of it numbered on from there (zeros when fixed)
    /// (2H + 1) coefficients a0, a1, b1, ... at a point.
    vector<double> coefficients(std::int64_t point, std::int64_t dof) const;
    double amplitude(std::int64_t point, std::int64_t dof, Measure measure, std::int64_t harmonic) const;
    double amplitude(std::int64_t point, const DofInBasis &dof, Measure measure, std::int64_t harmonic) const;
    /// The point where the amplitude is largest; 0 on an empty branch.
    std::int64_t highest_point(std::int64_t dof, Measure measure, std::int64_t harmonic) const;
    /// At n equidistant instants of the period, from its beginning.
    vector<double> history(std::int64_t point, std::int64_t dof, std::int64_t n) const;
    /// q on the free DOFs at t = fraction x period, one column.
    Field field(std::int64_t point, double fraction) const;
    /// Penetration coefficients (2H + 1) x Z of all pairs of the model, the gap included in a0.
    Matrix penetration_coefficients(std::int64_t point) const;
    /// Share of the period during which each pair of the model is closed, from the exact switching instants.
    vector<double> closed_share(std::int64_t point) const;
    /// Relative residual of the full-order harmonic-balance equations; see plm_branch_get_full_residual.
    double full_residual(std::int64_t point) const;

  private:
    vector<double> coefficients(std::int64_t point, const DofInBasis &dof) const;
    KnownMotion known_motion(std::int64_t point, std::int64_t dof) const;

    std::shared_ptr<const ReducedModel> reduced_;
    std::int64_t n_harmonics_ = 0;
    double force_scale_;
    std::int64_t period_multiple_;
    std::vector<BranchPoint> points_;
};

/// Whether the host or a spent effort stopped a curve, and PLM_CANCELLED with its reason for one: to be
/// called where it is a part of a larger answer.
bool was_stopped(const Branch &branch);
void require_unstopped(const Branch &branch);

} // namespace plm
