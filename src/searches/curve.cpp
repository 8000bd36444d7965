#include "searches/curve.hpp"
#include "searches/exact_curve.hpp"
#include "searches/harmonic_curve.hpp"

namespace plm {

void trace_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch) {
    constexpr double shorter = 1.0 / 3; // steps
    constexpr int times_shorter = 2;
    const auto trace = start.point.motion ? trace_exact_curve : trace_harmonic_curve;
    const auto known = static_cast<std::int64_t>(branch.points().size());
    const Warnings said = branch.warnings;
    trace(options, start, watch, branch);
    HbmOptions finer = options;
    for (int k = 0; k < times_shorter && branch.end_reason == PLM_REASON_CROSSED_OVER; ++k) {
        finer.max_step *= shorter;
        watch.log(
            1, format("the curve crossed over to a closed one; again with max_step = %.2g", finer.max_step));
        branch.truncate(known);
        branch.warnings = said;
        trace(finer, start, watch, branch);
    }
}

} // namespace plm
