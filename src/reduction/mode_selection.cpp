#include "reduction/mode_selection.hpp"
#include "linalg/parallel.hpp"
#include "reduction/static_basis.hpp"
#include "sampling/mode_match.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

double SelectionRule::highest_hz() const {
    return static_cast<double>(n_harmonics) * max_hz *
           (selection == ModeSelection::below ? below_factor : 1.0);
}

bool SelectionRule::keeps(double hz) const {
    if (selection == ModeSelection::below) return hz <= highest_hz();
    for (std::int64_t h = 1; h <= n_harmonics; ++h) {
        const double multiple = static_cast<double>(h);
        if (hz >= multiple * min_hz && hz <= multiple * max_hz) return true;
    }
    return false;
}

double SelectionRule::highest_eigenvalue() const {
    const double omega = 2 * M_PI * highest_hz() * (1 + 1e-12);
    return omega * omega;
}

Matrix kept_columns(const SpaceModes &modes, const vector<char> &kept) {
    Matrix columns(modes.vectors.rows(),
                   std::count_if(kept.begin(), kept.end(), [](char k) { return k != 0; }));
    std::int64_t next = 0;
    for (std::size_t j = 0; j < kept.size(); ++j)
        if (kept[j])
            std::copy_n(modes.vectors.col(static_cast<std::int64_t>(j)), columns.rows(), columns.col(next++));
    return columns;
}

Error no_mode_kept(const SelectionRule &rule, const char *who) {
    return Error(status::argument,
                 format("%s has a mode in the windows of %lld harmonics of [%.6g, %.6g] Hz; widen the window "
                        "or choose selection \"below\"",
                        who, static_cast<long long>(rule.n_harmonics), rule.min_hz, rule.max_hz))
        .argument("selection")
        .reason(reason::basis_too_small);
}

namespace {

// Of a mode's size: a part outside the basis that is not worth a word.
constexpr double held = 1e-2;

SampleSelection select_modes(const MatchedModes &found, const SelectionRule &rule) {
    SampleSelection s;
    for (double value : found.modes.values) {
        s.frequency_hz.push_back(to_hz(value));
        s.kept.push_back(rule.keeps(s.frequency_hz.back()));
    }
    s.matched = found.best;
    if (s.matched >= 0) {
        s.matched_mac = found.mac[s.matched];
        s.matched_kept = s.kept[s.matched] != 0;
    }
    return s;
}

bool is_lost(const SampleSelection &s) {
    return s.matched >= 0 && !s.matched_kept;
}

/// The next sample and what is kept of its modes.
void add_sample(const MatchedModes &found, const SelectionRule &rule, CollectedModes &collected) {
    collected.samples.push_back(select_modes(found, rule));
    const SampleSelection &sample = collected.samples.back();
    collected.columns.append(kept_columns(found.modes, sample.kept));
    if (is_lost(sample)) collected.lost.append(found.modes.vectors.columns(sample.matched, 1));
}

std::string remedy(const SelectionRule &rule) {
    if (rule.selection == ModeSelection::bands)
        return format("the resonance may be lost: widen the window [%.6g, %.6g] Hz or choose selection "
                      "\"below\"",
                      rule.min_hz, rule.max_hz);
    return format("raise below_factor or frequency_max_hz (modes are kept up to %.6g Hz)", rule.highest_hz());
}

} // namespace

void warn_of_lost_modes(const std::vector<SampleSelection> &samples, const Matrix &lost,
                        const Coordinates &basis, const SelectionRule &rule, Watch watch) {
    std::size_t n_lost = 0, first = 0;
    std::int64_t column = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!is_lost(samples[i])) continue;
        const double *mode = lost.col(column++);
        if (relative_remainder(basis, vector<double>(mode, mode + lost.rows())) <= held) continue;
        if (n_lost++ == 0) first = i;
    }
    if (n_lost == 0) return;
    const SampleSelection &s = samples[first];
    std::string text =
        format("sample %zu does not keep its mode at %.6g Hz, which resembles the dominant mode (MAC "
               "%.2f)",
               first, s.frequency_hz[s.matched], s.matched_mac);
    if (n_lost > 1) text += format(", nor do %zu other samples keep theirs", n_lost - 1);
    watch.warn(reason::lost_mode, text + "; " + remedy(rule));
}

CollectedModes collect_modes(const Space &space, const std::vector<SelectedSample> &samples,
                             const std::vector<vector<double>> &dominant, const SelectionRule &rule,
                             Watch watch) {
    CollectedModes collected;
    const auto count = static_cast<std::int64_t>(samples.size());
    for (std::int64_t first = 0; first < count; first += threads_at_hand()) { // the host is heard between
        watch.step("modes", static_cast<double>(first) / static_cast<double>(count));
        std::vector<MatchedModes> found(static_cast<std::size_t>(std::min(threads_at_hand(), count - first)));
        parallel_for(static_cast<std::int64_t>(found.size()), [&](std::int64_t k) {
            const SelectedSample &sample = samples[static_cast<std::size_t>(first + k)];
            found[static_cast<std::size_t>(k)] =
                match_modes(space, sample.states, dominant[sample.dominant], rule.highest_eigenvalue());
        });
        for (const MatchedModes &modes : found) add_sample(modes, rule, collected);
    }
    if (collected.columns.cols() == 0) throw no_mode_kept(rule, "no sample");
    return collected;
}

} // namespace plm
