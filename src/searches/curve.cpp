#include "searches/curve.hpp"
#include "hbm/harmonic_curve.hpp"
#include "orbits/exact_equations.hpp"
#include "orbits/stability.hpp"
#include "searches/point_equations.hpp"
#include <algorithm>

namespace plm {
namespace {

void trace_exact_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch,
                       CurveRecorder *recorder) {
    const BranchPoint *known = start.beside ? &start.beside->points().front() : nullptr;
    ExactEquations equations(branch.reduced_model(), options, start.point.omega, known);
    branch.unknowns_used = "state";
    CurveTracer(&equations, options, watch, branch, recorder).run(start);
    equations.orbits().modes()->forget_transitions(); // the points of the branch keep the modes
}

// A few beside folds, where the exact curve has turned already, are no reason to worry.
void warn_of_unverified(const HbmOptions &options, Branch &branch) {
    const auto &points = branch.points();
    const auto n = static_cast<std::int64_t>(points.size());
    const auto unverified = std::count_if(points.begin(), points.end(),
                                          [](const BranchPoint &p) { return p.multipliers.empty(); });
    if (10 * unverified > n)
        branch.warnings.add(reason::unverified,
                            Stability(branch.reduced_model(), options).unknown_text(unverified, n));
}

void trace_with_harmonics(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch,
                          CurveRecorder *recorder) {
    const MultipliersOf multipliers = multipliers_of(branch.reduced_model(), options);
    trace_harmonic_curve(options, start, multipliers, watch, branch, recorder);
    if (multipliers) warn_of_unverified(options, branch);
}

} // namespace

void trace_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch,
                 CurveRecorder *recorder) {
    constexpr double shorter = 1.0 / 3; // steps
    constexpr int times_shorter = 2;
    const auto trace = start.point.motion ? trace_exact_curve : trace_with_harmonics;
    const auto known = static_cast<std::int64_t>(branch.points().size());
    const Warnings said = branch.warnings;
    if (recorder && recorder->begin(options.max_points, branch)) return;
    HbmOptions finer = options;
    std::int64_t attempt = recorder && recorder->progress() ? recorder->progress()->attempt : 0;
    for (std::int64_t k = 0; k < attempt; ++k) finer.max_step *= shorter;
    trace(finer, start, watch, branch, recorder);
    while (attempt++ < times_shorter && branch.end_reason == reason::crossed_over) {
        finer.max_step *= shorter;
        watch.log(
            1, format("the curve crossed over to a closed one; again with max_step = %.2g", finer.max_step));
        branch.truncate(known);
        branch.warnings = said;
        if (recorder) recorder->begin_again(attempt);
        trace(finer, start, watch, branch, recorder);
    }
    if (recorder) recorder->end(branch);
}

} // namespace plm
