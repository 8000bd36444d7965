#include "sampling/sampler.hpp"
#include "sampling/contact_motion.hpp"
#include "sampling/dominant_mode.hpp"
#include "sampling/frequency_window.hpp"
#include "sampling/mode_match.hpp"
#include "sampling/reference_system.hpp"
#include "sampling/sampler_options.hpp"
#include "sampling/static_offset.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {
namespace {

constexpr double space_margin = 1.1; // accurate this far beyond the highest harmonic of the window

// The paper's harmonics at least. A motion in time has more of them, which cost nothing where few modes reach
// that far, and little where the structure is small enough for more modes.
constexpr std::int64_t least_harmonics = 5, least_of_small = 10, most_harmonics = 15;
constexpr std::int64_t small_structure = 10000; // DOFs

// Of the harmonic that drives the resonance, whatever else is known of the structure, so that the answer does
// not hang on what was asked before.
std::int64_t harmonics_within_reach(const Space &space, double window_max_hz, int driven) {
    if (space.n_exact_modes < modes_anyhow) return driven * most_harmonics; // these are all
    const double reach =
                     std::sqrt(space.lambda[modes_anyhow - 1]) / space.model->space_options().cutoff_factor,
                 n = reach / (2 * M_PI * space_margin * driven * window_max_hz);
    const std::int64_t least = space.model->n_free() <= small_structure ? least_of_small : least_harmonics;
    return driven * static_cast<std::int64_t>(
                        std::clamp(n, static_cast<double>(least), static_cast<double>(most_harmonics)));
}

// Exact modes of a first basis: with more, each of its points costs more than it tells, where what more of
// them change is estimated and they are added at need.
constexpr std::int64_t many_modes = 200;

double reach_of(std::int64_t n_harmonics, double window_max_hz) {
    return 2 * M_PI * space_margin * static_cast<double>(n_harmonics) * window_max_hz;
}

// As many of the harmonics proposed as a space reaches that was limited to many_modes.
std::int64_t harmonics_reached(const Space &space, double window_max_hz, int driven) {
    const double n = space.highest_frequency / reach_of(driven, window_max_hz);
    return driven * std::max<std::int64_t>(1, static_cast<std::int64_t>(n));
}

// Highest frequency (rad/s) that one can tell before the dominant mode is known; 0: none.
double first_guess(const SamplerOptions &o) {
    const double n = static_cast<double>(o.n_harmonics > 0 ? o.n_harmonics : least_harmonics),
                 factor = 2 * M_PI * space_margin * n;
    if (o.window_max_hz > 0) return factor * o.window_max_hz;
    if (o.mode == 0 && o.mode_frequency_hz > 0)
        return factor * o.mode_frequency_hz * (1 + 2 * o.window_half_width);
    return 2 * M_PI * o.search_max_hz;
}

std::int64_t least_modes(const SamplerOptions &o) {
    std::int64_t highest = o.mode;
    for (const SamplerOptions::Extra &e : o.extra) highest = std::max(highest, e.mode);
    return std::max<std::int64_t>(modes_anyhow, highest + 10);
}

std::vector<DominantMode> find_dominant_modes(const Space &space, const RestState &rest, bool homogeneous,
                                              const SamplerOptions &o, Watch watch) {
    ModeRequest request;
    request.mode = o.mode;
    request.frequency_hz = o.mode_frequency_hz;
    request.search_min_hz = o.search_min_hz;
    request.search_max_hz = o.search_max_hz;
    request.system = reference_system(o.system, space, rest, homogeneous, request);
    std::vector<DominantMode> dominant;
    dominant.push_back(find_dominant_mode(space, request, watch));
    for (const SamplerOptions::Extra &e : o.extra) {
        ModeRequest further;
        further.system = e.system;
        further.mode = e.mode;
        dominant.push_back(find_dominant_mode(space, further, watch));
    }
    return dominant;
}

ContactSweep sweep_of(const Space &space, const RestState &rest, bool homogeneous, const DominantMode &d,
                      Watch watch) {
    if (!(contact_motion(space, d.mode_penetration, 2 * M_PI * d.frequency_hz) > no_contact_motion)) {
        watch.warn(
            reason::lost_mode,
            format("the dominant mode at %.6g Hz does not move the contact: there is one sample only; name "
                   "the mode of the resonance that opens and closes the contact (\"mode\" or "
                   "\"mode_frequency_hz\")",
                   d.frequency_hz));
        return sweep_contact(rest.penetration, !homogeneous, vector<double>(space.n_pairs(), 0.0));
    }
    if (!homogeneous) return sweep_contact(rest.penetration, true, d.mode_penetration);
    return sweep_contact(static_offset(space, d.system, d.mode_penetration), false, d.mode_penetration);
}

} // namespace

Sampler::Sampler(std::shared_ptr<const Model> model, const SamplerOptions &options, Watch host,
                 std::shared_ptr<const Space> known)
    : options_(options), space_(std::move(known)), n_harmonics_(options.n_harmonics) {
    check_options(options);
    if (model->n_pairs() == 0) throw Error(status::state, "the model has no contact pair to sample");
    const bool homogeneous = is_homogeneous(*model);
    Watch watch = host;
    double highest = first_guess(options);
    SpaceLimits limits;
    limits.provisional = highest == 0;
    if (options.n_harmonics == 0) {
        limits.most_modes = many_modes;
        limits.least_frequency = std::max(highest / least_harmonics, 2 * M_PI * options.search_max_hz);
    }
    for (int round = 0; round < 4; ++round) {
        watch.step("sampler", 0.25 * round);
        warnings_ = Warnings(); // those of the last round stand
        watch = host.keeping(warnings_);
        space_ = make_contact_space(model, highest, least_modes(options), watch, space_, limits);
        rest_ = rest_of(*space_);
        dominant_ = find_dominant_modes(*space_, *rest_, homogeneous, options, watch);
        sweeps_.clear();
        for (const DominantMode &d : dominant_)
            sweeps_.push_back(sweep_of(*space_, *rest_, homogeneous, d, watch));
        window_ = find_window(*space_, dominant_.front(), sweeps_.front(), *rest_, options, watch);
        const int driven = dominant_.front().harmonic;
        if (n_harmonics_ == 0)
            n_harmonics_ = harmonics_within_reach(*space_, window_.max_hz, driven);
        else if (options.n_harmonics == 0 && space_->highest_frequency < highest)
            n_harmonics_ = harmonics_reached(*space_, window_.max_hz, driven);
        if (space_->highest_frequency >= reach_of(n_harmonics_, window_.max_hz)) break;
        constexpr double room = 1.01; // the frequencies move a little in the better space
        highest = room * reach_of(n_harmonics_, window_.max_hz);
        limits.provisional = false;
        limits.least_frequency = room * reach_of(driven, window_.max_hz);
    }
    samples_ = select_samples(sweeps_, options.n_samples, options.include_ends, options.complements,
                              options.include_rest);
    watch.log(
        1,
        format("dominant mode %lld of the %s system at %.6g Hz; %zu contact sets in its sweep, %zu samples; "
               "window [%.6g, %.6g] Hz: %s",
               static_cast<long long>(dominant_.front().mode), name_of(dominant_.front().system),
               dominant_.front().frequency_hz, sweeps_.front().samples.size(), samples_.size(),
               window_.min_hz, window_.max_hz, window_.why.c_str()));
}

} // namespace plm
