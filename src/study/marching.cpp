#include "study/marching.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t most_harmonics =
    50; // of a recorded period; its coefficients fall with the fourth power

// a0, a1, b1, ... of a period sampled at n equidistant instants.
vector<double> coefficients(const vector<double> &value, std::int64_t multiple) {
    const std::int64_t n = static_cast<std::int64_t>(value.size()),
                       h = std::max<std::int64_t>(1, std::min((n - 1) / 2, most_harmonics * multiple));
    vector<double> c(2 * h + 1, 0.0);
    for (std::int64_t k = 0; k < n; ++k) {
        worked(40.0 * static_cast<double>(h));
        c[0] += value[k] / static_cast<double>(n);
        for (std::int64_t j = 1; j <= h; ++j) {
            const double angle = 2 * M_PI * static_cast<double>(j * (k + 1) % n) / static_cast<double>(n);
            c[2 * j - 1] += 2 * value[k] * std::cos(angle) / static_cast<double>(n);
            c[2 * j] += 2 * value[k] * std::sin(angle) / static_cast<double>(n);
        }
    }
    return c;
}

TransientRun uncancelled(TransientRun run) {
    if (run.cancelled)
        throw Error(status::cancelled, "cancelled by the progress callback").reason(reason::cancelled);
    return run;
}

} // namespace

MarchedCurve march_curve(Transient &motion, const TransientOptions &options, const Output &output,
                         const FrequencyRange &range, std::int64_t n_frequencies, double force_scale,
                         Watch watch) {
    MarchedCurve curve;
    for (std::int64_t k = 0; k < n_frequencies; ++k) {
        const double done =
            n_frequencies > 1 ? static_cast<double>(k) / static_cast<double>(n_frequencies - 1) : 0.5;
        watch.step("marching", done);
        TransientOptions o = options;
        o.frequency_hz = range.high_hz - done * (range.high_hz - range.low_hz);
        o.force_scale = force_scale;
        const TransientRun settling = uncancelled(motion.run(o, {}, watch));
        if (o.settled > 0 && !settling.settled) ++curve.unsettled;
        o.periods = o.period_multiple;
        o.settled = 0;
        const TransientRun period = uncancelled(motion.run(o, {output.dof}, watch));
        const std::int64_t n = o.period_multiple * o.steps_per_period;
        if (static_cast<std::int64_t>(period.values.size()) < n)
            throw Error(status::internal, "a marched period was not recorded as a whole");
        const vector<double> last(period.values.end() - n, period.values.end());
        curve.samples.hz.push_back(o.frequency_hz);
        curve.samples.amplitude.push_back(
            amplitude_of(coefficients(last, o.period_multiple), output.measure, output.harmonic));
    }
    return curve;
}

} // namespace plm
