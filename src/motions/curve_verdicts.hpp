// What is said with a curve that was followed to its end: whether basis and contact were what it is about.
#pragma once
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"
#include "reduction/sweep_range.hpp"
#include <functional>

namespace plm {

/// A basis is made for its window. Beyond it many bases still serve: the largest response there is put into
/// the equations of the whole structure, once, and what they miss decides.
void check_window(const SweepRange &window, Watch watch, Branch &branch);

/// Of a curve whose motions met the equations of the whole structure clearly: so do those of somewhat less
/// force.
struct JudgedForce {
    double force = 0; // 0: there is none
    bool speaks_for(double other) const;
};

/// A basis may be too small inside its window, too, where the contact is much stiffer than what it touches or
/// many harmonics are needed: the largest response there is judged in the same way, unless `error`, which is
/// then asked for, knows better: the estimated error (basis_error.hpp), infinite or NaN where there is none.
/// judged: not again, where a curve of more force speaks for this one; null: there is none.
void check_basis(const SweepRange &window, const std::function<double()> &error, Watch watch, Branch &branch,
                 JudgedForce *judged = nullptr);

/// The same of a peak and its estimated error, which is to be within the accuracy; infinite: its steps do not
/// contract.
void check_peak(const SweepRange &window, double accuracy, double error, Watch watch, Branch &peak);

/// A peak around which no solutions were found is the highest point of its curve, and may be higher by
/// `above` of itself.
void check_top(double accuracy, double above, Watch watch, Branch &peak);

/// The highest point of a curve that is stable, or where stable motions end; -1: none.
std::int64_t highest_stable(const Branch &curve, const Output &of);

/// The unstable points that the structure need not leave for a stable motion of the curve.
vector<std::int64_t> left_for_others(const Branch &curve);

/// A peak whose motion is not stable is not what the structure does, unless stable motions end at a fold
/// beside it, as high within the accuracy.
void check_stability(const Branch &curve, const Output &of, double accuracy, Watch watch, Branch &peak);

/// Where a host's own reduction (a superelement) takes more than its share (error_budget.hpp), no basis can
/// mend it. error: of the basis, as estimated.
void check_host_reduction(const Model &model, double accuracy, double error, Watch watch);

/// A curve that folds and comes back to the end of the range where it began, or to its first point, says
/// nothing of the rest. upward: how it was to be followed.
void check_span(bool upward, Watch watch, Branch &branch);
/// Whether a curve goes from one end of its range to the other, after check_span().
bool spans(const Branch &curve);

/// Through a resonance that nothing damps no curve comes, and what it shows there is no height.
void check_damping(Watch watch, Branch &branch);

/// A curve on which no pair comes near to opening or closing is a linear response, most often of a gap or a
/// pre-load in other units than the force.
void check_switching(Watch watch, Branch &branch);

} // namespace plm
