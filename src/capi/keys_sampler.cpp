#include "capi/handles.hpp"
#include "capi/keys.hpp"

namespace plm::capi {
namespace {

using H = SamplerHandle;
using Ints = vector<std::int64_t>;
using Reals = vector<double>;

const Sampler &core(const H &h) {
    return *built(h);
}
const FrequencyWindow &window(const H &h) {
    return core(h).window();
}
const DominantMode &main_mode(const H &h) {
    return core(h).dominant().front();
}

/// One value per element of a list, or several concatenated.
template <class Out, class List, class Get> Out each(const List &list, Get get) {
    Out out;
    for (const auto &x : list) out.push_back(get(x));
    return out;
}
template <class Out, class List, class Get> Out joined(const List &list, Get get) {
    Out out;
    for (const auto &x : list) {
        const auto &part = get(x);
        out.insert(out.end(), part.begin(), part.end());
    }
    return out;
}

Ints sweep_samples(const H &h) {
    Ints out;
    for (const ContactSweep &sweep : core(h).sweeps())
        for (const PairStates &states : sweep.samples) {
            const Ints flags = states.flags();
            out.insert(out.end(), flags.begin(), flags.end());
        }
    return out;
}

std::int64_t n_sweep_samples(const H &h) {
    std::int64_t n = 0;
    for (const ContactSweep &sweep : core(h).sweeps()) n += static_cast<std::int64_t>(sweep.samples.size());
    return n;
}

/// Row of the MAC table by the system's name; empty when that system was not compared.
Reals mac_row(const H &h, const char *system, Reals MacRow::*what) {
    for (const MacRow &row : window(h).mac)
        if (row.system == system) return row.*what;
    return {};
}

void add_options(std::vector<Key> &keys) {
    using O = SamplerOptions;
    keys.insert(
        keys.end(),
        {
            choice_option<&O::system, -1>(
                "system", "auto,open,sliding,rest",
                "linear system of the dominant mode; rest: the pairs closed at rest are coupled; auto: "
                "sliding when most pairs are closed at rest, else open, or what holds parts that float then; "
                "without pre-load and gap open, unless contact alone holds a part or the sliding mode "
                "explains both half cycles clearly better"),
            int_option<&O::mode>("mode", 0, 1e6,
                                 "number of the dominant mode, 1, 2, ...; 0: by mode_frequency_hz, or "
                                 "proposed by its participation"),
            real_option<&O::mode_frequency_hz>(
                "mode_frequency_hz", 0, huge, "the dominant mode is the one nearest to it (Hz); 0: proposed"),
            real_option<&O::search_min_hz>("search_min_hz", 0, huge,
                                           "proposal: lower end of the search (Hz)"),
            real_option<&O::search_max_hz>("search_max_hz", 0, huge,
                                           "proposal: upper end of the search (Hz); 0: the 20 lowest modes"),
            int_option<&O::n_samples>("n_samples", 1, 1e6, "contact samples taken from each sweep"),
            int_option<&O::complements>("complements", 0, 1, "1: open and closed exchanged are samples, too"),
            int_option<&O::include_ends>("include_ends", 0, 1,
                                         "1: the samples span the sweep with its two ends"),
            int_option<&O::include_rest>("include_rest", 0, 1,
                                         "1: with pre-load, the contact set at rest is among the samples"),
            real_option<&O::window_half_width>(
                "window_half_width", 1e-6, 0.9,
                "half width of the window as a share of the estimated resonance"),
            real_option<&O::window_min_hz>("window_min_hz", 0, huge,
                                           "lower end of the window (Hz); 0: estimated"),
            real_option<&O::window_max_hz>("window_max_hz", 0, huge,
                                           "upper end of the window (Hz); 0: estimated"),
            int_option<&O::n_harmonics>(
                "n_harmonics", 0, 1000,
                "harmonics of the window up to which the contact space is accurate; "
                "0: from 5 (10 up to 10000 DOFs) to 15, as far as the modes reach that "
                "are computed anyhow, "
                "and fewer where more than 200 modes lie below"),
        });
}

void add_sweep_results(std::vector<Key> &keys) {
    keys.insert(
        keys.end(),
        {
            result<H>("dominant_system", "linear system of the dominant mode: open, sliding or rest",
                      [](const H &h) { return std::string(name_of(main_mode(h).system)); }),
            result<H>("dominant_mode", "number of the dominant mode in its system, 1, 2, ...",
                      [](const H &h) { return main_mode(h).mode; }),
            result<H>("dominant_frequency_hz", "frequency of the dominant mode (Hz)",
                      [](const H &h) { return main_mode(h).frequency_hz; }),
            result<H>("dominant_participation",
                      "share of the dominant mode in the drive-point response, 0..1",
                      [](const H &h) { return main_mode(h).participation; }),
            result<H>("n_harmonics_used", "harmonics of the window up to which the contact space is accurate",
                      [](const H &h) { return core(h).n_harmonics(); }),
            result<H>("n_dominant", "dominant modes swept",
                      [](const H &h) { return static_cast<std::int64_t>(core(h).dominant().size()); }),
            result<H>("dominant_systems", "PLM_SYSTEM_OPEN, _SLIDING or _REST of every dominant mode",
                      [](const H &h) {
                          return each<Ints>(core(h).dominant(),
                                            [](auto &d) { return static_cast<std::int64_t>(d.system); });
                      }),
            result<H>(
                "dominant_modes", "number of every dominant mode",
                [](const H &h) { return each<Ints>(core(h).dominant(), [](auto &d) { return d.mode; }); }),
            result<H>("dominant_frequencies_hz", "frequency of every dominant mode (Hz)",
                      [](const H &h) {
                          return each<Reals>(core(h).dominant(), [](auto &d) { return d.frequency_hz; });
                      }),
            result<H>("dominant_participations", "participation of every dominant mode",
                      [](const H &h) {
                          return each<Reals>(core(h).dominant(), [](auto &d) { return d.participation; });
                      }),
            result<H>("mode_penetration", "dV = B phi, n_pairs x n_dominant (1/sqrt(mass))",
                      [](const H &h) {
                          return joined<Reals>(
                              core(h).dominant(), [](auto &d) -> auto & { return d.mode_penetration; });
                      }),
            result<H>("offset", "penetration the sweeps start from, n_pairs x n_dominant (length)",
                      [](const H &h) {
                          return joined<Reals>(
                              core(h).sweeps(), [](auto &s) -> auto & { return s.offset; });
                      }),
            result<H>("offset_is_rest", "1: the offset is the penetration at rest; 0: the static offset",
                      [](const H &h) {
                          return static_cast<std::int64_t>(core(h).sweeps().front().offset_is_rest);
                      }),
            result<H>("thresholds", "alpha at which pairs switch, ascending, sweep after sweep",
                      [](const H &h) {
                          return joined<Reals>(
                              core(h).sweeps(), [](auto &s) -> auto & { return s.thresholds; });
                      }),
            result<H>("n_thresholds", "thresholds of every sweep",
                      [](const H &h) {
                          return each<Ints>(core(h).sweeps(), [](auto &s) {
                              return static_cast<std::int64_t>(s.thresholds.size());
                          });
                      }),
            result<H>("n_sweep_samples", "contact sets of all sweeps together", n_sweep_samples),
            result<H>("sweep_samples", "closed (1) or open (0), n_pairs x n_sweep_samples", sweep_samples),
            result<H>("sweep_alpha", "a representative alpha of every contact set",
                      [](const H &h) {
                          return joined<Reals>(
                              core(h).sweeps(), [](auto &s) -> auto & { return s.alpha; });
                      }),
        });
}

void add_selection_results(std::vector<Key> &keys) {
    keys.insert(
        keys.end(),
        {
            result<H>("n_selected", "samples selected, complements included",
                      [](const H &h) { return static_cast<std::int64_t>(core(h).samples().size()); }),
            result<H>("selected_samples", "closed (1) or open (0), n_pairs x n_selected",
                      [](const H &h) {
                          return joined<Ints>(core(h).samples(), [](auto &s) { return s.states.flags(); });
                      }),
            result<H>(
                "selected_dominant", "which dominant mode's sweep each sample comes from, from 0",
                [](const H &h) { return each<Ints>(core(h).samples(), [](auto &s) { return s.dominant; }); }),
            result<H>("selected_index", "position of each sample in its sweep, from 0",
                      [](const H &h) {
                          return each<Ints>(core(h).samples(), [](auto &s) { return s.sweep_index; });
                      }),
            result<H>("selected_complement", "1 for samples that are complements",
                      [](const H &h) {
                          return each<Ints>(core(h).samples(),
                                            [](auto &s) { return static_cast<std::int64_t>(s.complement); });
                      }),
            result<H>("selected_n_closed", "closed pairs of each sample",
                      [](const H &h) {
                          return each<Ints>(core(h).samples(), [](auto &s) { return s.states.n_closed(); });
                      }),
        });
}

void add_window_results(std::vector<Key> &keys) {
    keys.insert(
        keys.end(),
        {
            result<H>("blf_hz", "bilinear frequency 2 f1 f2 / (f1 + f2) (Hz)",
                      [](const H &h) { return window(h).blf_hz; }),
            result<H>("f1_hz", "frequency of the first half-cycle system (Hz)",
                      [](const H &h) { return window(h).f1_hz; }),
            result<H>("f2_hz", "frequency of the second half-cycle system (Hz)",
                      [](const H &h) { return window(h).f2_hz; }),
            result<H>("rest_hz", "frequency with the pairs closed as at rest (Hz); 0 without pre-load",
                      [](const H &h) { return window(h).rest_hz; }),
            result<H>("preload_case", "1: case with pre-load (paper, case B)",
                      [](const H &h) { return static_cast<std::int64_t>(window(h).preload_case); }),
            result<H>("window_low_hz", "lower end of the frequency window (Hz), of the excitation",
                      [](const H &h) { return window(h).min_hz; }),
            result<H>("window_high_hz", "upper end of the frequency window (Hz), of the excitation",
                      [](const H &h) { return window(h).max_hz; }),
            result<H>("window_why", "one sentence: where the window comes from",
                      [](const H &h) { return window(h).why; }),
            result<H>("mac_frequencies_1_hz", "lowest modes of half-cycle system 1 (Hz)",
                      [](const H &h) { return mac_row(h, "system 1", &MacRow::frequency_hz); }),
            result<H>("mac_1", "MAC of these modes with the dominant mode",
                      [](const H &h) { return mac_row(h, "system 1", &MacRow::mac); }),
            result<H>("mac_frequencies_2_hz", "lowest modes of half-cycle system 2 (Hz)",
                      [](const H &h) { return mac_row(h, "system 2", &MacRow::frequency_hz); }),
            result<H>("mac_2", "MAC of these modes with the dominant mode",
                      [](const H &h) { return mac_row(h, "system 2", &MacRow::mac); }),
            result<H>("mac_frequencies_rest_hz", "lowest modes of the system closed as at rest (Hz)",
                      [](const H &h) { return mac_row(h, "rest", &MacRow::frequency_hz); }),
            result<H>("mac_rest", "MAC of these modes with the dominant mode",
                      [](const H &h) { return mac_row(h, "rest", &MacRow::mac); }),
            result<H>("space_description", "what the modes were computed in",
                      [](const H &h) { return core(h).space()->description; }),
            result<H>("space_error", "relative error of the contact receptances at the highest frequency",
                      [](const H &h) { return core(h).space()->error_estimate; }),
            warning_text<H>(warnings_of),
            warning_reasons<H>(warnings_of),
        });
}

} // namespace

const std::vector<Key> &sampler_keys() {
    static const std::vector<Key> keys = [] {
        std::vector<Key> k;
        add_options(k);
        add_sweep_results(k);
        add_selection_results(k);
        add_window_results(k);
        return k;
    }();
    return keys;
}

} // namespace plm::capi
