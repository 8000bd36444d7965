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

// Of a mode's kinetic energy: with less in the best of them, it is spread over so many that none of them is
// the dominant one. (Where two have half of it each, both are told: tell_of_rivals().)
constexpr double resembles = 1.0 / 3;

// The frequency of the mode that resembles the dominant one; its row is added to the table. `decides`: the
// window stands or falls with it, otherwise it only makes it wider than it need be.
double matched_frequency(const Space &space, const DominantMode &dominant, const PairStates &states,
                         const char *name, bool decides, FrequencyWindow &window, Watch watch) {
    const double omega = 2 * M_PI * dominant.frequency_hz;
    const MatchedModes matched = match_modes(space, states, dominant.coordinates, 9 * omega * omega);
    if (matched.best < 0)
        throw Error(status::eigensolver, std::string("the linear system of ") + name + " has no mode");
    MacRow row;
    row.system = name;
    row.best = matched.best;
    const std::int64_t listed =
        std::min(matched.modes.vectors.cols(), std::max<std::int64_t>(10, matched.best + 3));
    for (std::int64_t j = 0; j < listed; ++j) {
        row.frequency_hz.push_back(to_hz(matched.modes.values[j]));
        row.mac.push_back(matched.mac[j]);
    }
    const double best = matched.likeness, hz = row.frequency_hz[row.best];
    if (matched.rival >= 0 && best >= resembles) row.rival_hz = to_hz(matched.modes.values[matched.rival]);
    if (best < resembles) {
        const std::string text = format(
            "no mode of %s resembles the dominant mode: the best, at %.6g Hz, has a MAC of %.2f; check "
            "the frequency window or choose another dominant mode",
            name, hz, best);
        if (decides)
            watch.warn(reason::lost_mode, text);
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

// Where two modes of a half cycle resemble the dominant one alike, another resonance belongs to each.
void tell_of_rivals(const FrequencyWindow &w, const DominantMode &dominant, Watch watch) {
    const double found = w.blf_hz > 0 ? w.blf_hz : w.rest_hz;
    for (const MacRow &row : w.mac) {
        if (row.rival_hz == 0) continue;
        const bool is_first = row.system == "system 1", is_second = row.system == "system 2";
        const double other = is_first    ? bilinear_frequency(row.rival_hz, w.f2_hz)
                             : is_second ? bilinear_frequency(w.f1_hz, row.rival_hz)
                                         : row.rival_hz,
                     hz = other / dominant.harmonic;
        if (!(other > 0) || (hz >= w.min_hz && hz <= w.max_hz)) continue;
        watch.warn(
            reason::tie,
            format("two modes of %s resemble the dominant mode alike, at %.6g Hz and at %.6g Hz, and "
                   "so there are two resonances: the window is about the one estimated at %.6g Hz; the "
                   "other is near %.6g Hz and may be higher. Look at that, too: window_min_hz and "
                   "window_max_hz of a sampler",
                   row.system.c_str(), row.frequency_hz[row.best], row.rival_hz, found / dominant.harmonic,
                   hz));
    }
}

void estimate(double half_width, const DominantMode &dominant, FrequencyWindow &w) {
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
    if (dominant.harmonic > 1) {
        w.min_hz /= dominant.harmonic;
        w.max_hz /= dominant.harmonic;
        w.why += format(", over %d, the harmonic of the excitation that drives it", dominant.harmonic);
    }
    if (w.max_hz > 0) return;
    throw Error(status::argument,
                "no frequency window follows from the dominant mode, which is a rigid-body motion of "
                "the linear systems compared; choose a flexible mode or give the window")
        .argument("mode");
}

// A window without the dominant mode that would hold it if its limits were angular frequencies.
void check_unit(const FrequencyWindow &w, int harmonic, Watch watch) {
    const auto holds = [&](double hz) { return hz >= w.min_hz * harmonic && hz <= w.max_hz * harmonic; };
    for (double hz : {w.f1_hz, w.f2_hz, w.rest_hz, w.blf_hz})
        if (hz > 0 && holds(hz)) return;
    const double resonance = w.blf_hz > 0 ? w.blf_hz : w.rest_hz;
    if (!holds(2 * M_PI * resonance) && !holds(2 * M_PI * w.rest_hz)) return;
    watch.warn(reason::outside_basis,
               format("the window, %.6g to %.6g Hz, does not hold the resonance of the dominant mode, near "
                      "%.6g Hz, but would if its limits were in rad/s, which are wanted in Hz. Divide them "
                      "by 2 pi; or, if another mode is meant, name it (\"mode\" or \"mode_frequency_hz\")",
                      w.min_hz, w.max_hz, resonance / harmonic));
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
        check_unit(w, dominant.harmonic, watch);
    } else {
        estimate(options.window_half_width, dominant, w);
        tell_of_rivals(w, dominant, watch);
    }
    return w;
}

} // namespace plm
