#include "orbits/larger_in_time.hpp"
#include "linalg/work.hpp"
#include "motions/curve_verdicts.hpp"
#include "motions/effort_budget.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/recorded_motion.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::size_t most_marched = 12; // frequencies
constexpr double comparable = 0.5;       // of the peak
constexpr double disturbed = 1.01;
constexpr int leaving = 200, watched = 50; // periods

// The largest amplitude over a period, once the structure has left that motion.
double amplitude_after(const Branch &curve, const BranchPoint &begin, const Output &of, Watch watch) {
    const auto model = std::make_shared<FlowModel>(curve.reduced_model(), begin.omega);
    ExactFlow flow(model, begin.omega, begin.force_scale, watch, std::make_shared<ContactModesKept>(model));
    FlowState state = start_of(*model, begin, curve.period_multiple());
    for (double &v : state.v) v *= disturbed;
    flow.complete(state);
    const double period = static_cast<double>(curve.period_multiple()) * flow.period();
    flow.advance(state, leaving * period);
    const vector<double> of_dof = model->dof_row(of.dof);
    Matrix row(1, model->size());
    std::copy(of_dof.begin(), of_dof.end(), row.data());
    const KnownMotion known = curve.reduced().model->known_motion(of.dof, begin.omega, begin.force_scale);
    double most = 0;
    for (int k = 1; k <= watched; ++k) {
        RecordedMotion record;
        flow.advance(state, (leaving + k) * period, &record);
        most = std::max(most, amplitude_of(record.ranges(row, known, begin.omega)[0], of.measure));
    }
    return most;
}

vector<std::int64_t> unstable_points(const Branch &curve, const Output &of, double peak) {
    vector<std::int64_t> at;
    for (const std::int64_t i : left_for_others(curve))
        if (curve.points()[static_cast<std::size_t>(i)].motion &&
            curve.amplitude(i, of.dof, of.measure, of.harmonic) > comparable * peak)
            at.push_back(i);
    return at;
}

} // namespace

std::optional<MotionInTime> find_larger_in_time(const Branch &curve, const Output &of, double peak,
                                                double accuracy, Watch watch) {
    if (of.measure != Measure::peak && of.measure != Measure::half_peak_to_peak) return std::nullopt;
    const vector<std::int64_t> at = unstable_points(curve, of, peak);
    const std::size_t n = std::min(most_marched, at.size());
    MotionInTime largest;
    const auto march = [&] {
        for (std::size_t k = 0; k < n; ++k) {
            const auto i = static_cast<std::size_t>(at[(2 * k + 1) * at.size() / (2 * n)]);
            const BranchPoint &begin = curve.points()[i];
            const double reached = amplitude_after(curve, begin, of, watch);
            if (reached > largest.amplitude) largest = {begin.omega / (2 * M_PI), reached};
        }
    };
    try {
        within(std::max(EffortBudget::aside, EffortBudget::half * effort_left()), march);
    } catch (const Error &e) { // chatter: what was reached until then counts
        if (e.status() == status::cancelled || e.status() == status::memory) throw;
    }
    if (!(largest.amplitude > (1 + accuracy) * peak)) return std::nullopt;
    return largest;
}

std::string words_for(const MotionInTime &larger, double peak) {
    return format(
        "the curve is not stable everywhere: in time the structure leaves it, and at %.6g Hz, where "
        "that was followed, comes to %.6g, %.4g times the peak, in a motion that may repeat after "
        "several periods of the excitation or not at all. March in time there, or follow a curve "
        "with \"period_multiple\" of 2 or more",
        larger.frequency_hz, larger.amplitude, larger.amplitude / peak);
}

} // namespace plm
