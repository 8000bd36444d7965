#include "searches/curve.hpp"
#include "searches/exact_curve.hpp"
#include "searches/harmonic_curve.hpp"

namespace plm {

void trace_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch) {
    (start.point.motion ? trace_exact_curve : trace_harmonic_curve)(options, start, watch, branch);
}

} // namespace plm
