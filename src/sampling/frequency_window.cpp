#include "sampling/frequency_window.hpp"
#include "sampling/mode_match.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {

double bilinear_frequency(double f1_hz, double f2_hz) {
    return f1_hz > 0 && f2_hz > 0 ? 2 / (1 / f1_hz + 1 / f2_hz) : 0;
}

namespace {

// Half of a mode's kinetic energy: below it the mode is more unlike than like the dominant one.
constexpr double resembles = 0.5;

// The frequency of the mode that resembles the dominant one; its row is added to the table. `decides`: the
// window stands or falls with it, otherwise it only makes it wider than it need be.
double matched_frequency(const Space &space, const DominantMode &dominant, const PairStates &states,
                         const char *name, bool decides, FrequencyWindow &window, Watch watch) {
    const double omega = 2 * M_PI * dominant.frequency_hz;
    const MatchedModes matched = match_modes(space, states, dominant.coordinates, 9 * omega * omega);
    if (matched.best < 0)
        throw Error(PLM_ERR_EIGENSOLVER, std::string("the linear system of ") + name + " has no mode");
    MacRow row;
    row.system = name;
    row.best = matched.best;
    const std::int64_t listed =
        std::min(matched.modes.vectors.cols(), std::max<std::int64_t>(10, matched.best + 3));
    for (std::int64_t j = 0; j < listed; ++j) {
        row.frequency_hz.push_back(to_hz(matched.modes.values[j]));
        row.mac.push_back(matched.mac[j]);
    }
    const double best = row.mac[row.best], hz = row.frequency_hz[row.best];
    if (best < resembles) {
        const std::string text = format(
            "no mode of %s resembles the dominant mode: the best, at %.6g Hz, has a MAC of %.2f; check "
            "the frequency window or choose another dominant mode",
            name, hz, best);
        if (decides)
            watch.warn(PLM_REASON_LOST_MODE, text);
        else
            watch.log(1, text);
    }
    window.mac.push_back(std::move(row));
    return hz;
}

void around(double least, double most, double half_width, FrequencyWindow &window) {
    window.min_hz = least * (1 - half_width);
    window.max_hz = most * (1 + half_width);
}

void estimate(double half_width, FrequencyWindow &w) {
    const double percent = 100 * half_width;
    if (!w.preload_case) {
        around(w.blf_hz, w.blf_hz, half_width, w);
        w.why =
            format("bilinear frequency %.6g Hz of the half-cycle frequencies %.6g and %.6g Hz, -+ %.3g %%",
                   w.blf_hz, w.f1_hz, w.f2_hz, percent);
    } else if (w.blf_hz > 0) {
        around(std::min(w.rest_hz, w.blf_hz), std::max(w.rest_hz, w.blf_hz), half_width, w);
        w.why = format(
            "from the frequency with the contact as at rest, %.6g Hz, to the bilinear frequency, %.6g Hz "
            "(of %.6g and %.6g Hz), -+ %.3g %%",
            w.rest_hz, w.blf_hz, w.f1_hz, w.f2_hz, percent);
    } else { // a rigid-body half cycle has no frequency
        around(w.rest_hz, w.rest_hz, half_width, w);
        w.why = format("frequency with the contact as at rest, %.6g Hz, -+ %.3g %%", w.rest_hz, percent);
    }
    if (w.max_hz > 0) return;
    throw Error(PLM_ERR_ARGUMENT,
                "no frequency window follows from the dominant mode, which is a rigid-body motion of "
                "the linear systems compared; choose a flexible mode or give the window")
        .argument("mode");
}

// A window without the dominant mode that would hold it if its limits were angular frequencies.
void check_unit(const FrequencyWindow &w, Watch watch) {
    const auto holds = [&](double hz) { return hz >= w.min_hz && hz <= w.max_hz; };
    for (double hz : {w.f1_hz, w.f2_hz, w.rest_hz, w.blf_hz})
        if (hz > 0 && holds(hz)) return;
    const double resonance = w.blf_hz > 0 ? w.blf_hz : w.rest_hz;
    if (!holds(2 * M_PI * resonance) && !holds(2 * M_PI * w.rest_hz)) return;
    watch.warn(PLM_REASON_OUTSIDE_BASIS,
               format("the window, %.6g to %.6g Hz, does not hold the resonance of the dominant mode, near "
                      "%.6g Hz, but would if its limits were in rad/s, which are wanted in Hz. Divide them "
                      "by 2 pi; or, if another mode is meant, name it (\"mode\" or \"mode_frequency_hz\")",
                      w.min_hz, w.max_hz, resonance));
}

} // namespace

FrequencyWindow find_window(const Space &space, const DominantMode &dominant, const ContactSweep &sweep,
                            const RestState &rest, const SamplerOptions &options, Watch watch) {
    FrequencyWindow w;
    w.preload_case = sweep.offset_is_rest;
    const bool estimated = options.window_max_hz == 0, by_halves = estimated && !w.preload_case;
    w.f1_hz = matched_frequency(space, dominant, sweep.samples.back(), "system 1", by_halves, w, watch);
    w.f2_hz = matched_frequency(space, dominant, sweep.samples.front(), "system 2", by_halves, w, watch);
    w.blf_hz = bilinear_frequency(w.f1_hz, w.f2_hz);
    if (w.preload_case)
        w.rest_hz = matched_frequency(space, dominant, rest.states, "rest", estimated, w, watch);
    if (!estimated) {
        w.min_hz = options.window_min_hz;
        w.max_hz = options.window_max_hz;
        w.why = format("given by the caller; the bilinear frequency is %.6g Hz", w.blf_hz);
        if (w.preload_case) w.why += format(", that with the contact as at rest %.6g Hz", w.rest_hz);
        check_unit(w, watch);
    } else {
        estimate(options.window_half_width, w);
    }
    return w;
}

} // namespace plm
