#include "sampling/sample_selection.hpp"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace plm {
namespace {

void add_unless_present(std::vector<SelectedSample> &samples, SelectedSample sample) {
    for (const SelectedSample &s : samples)
        if (s.states == sample.states) return;
    samples.push_back(std::move(sample));
}

// The ends stay where they are as long as there is an inner position to move; of two as near, as around the
// middle of a sweep, the later one moves.
void move_nearest(vector<std::int64_t> &chosen, std::int64_t target) {
    if (chosen.empty() || std::find(chosen.begin(), chosen.end(), target) != chosen.end()) return;
    const bool inner = chosen.size() > 2;
    *std::min_element(chosen.rbegin() + inner, chosen.rend() - inner, [&](std::int64_t a, std::int64_t b) {
        return std::abs(a - target) < std::abs(b - target);
    }) = target;
    std::sort(chosen.begin(), chosen.end());
}

} // namespace

vector<std::int64_t> equally_spaced(const ContactSweep &sweep, std::int64_t n_samples, bool with_ends) {
    const std::int64_t size = static_cast<std::int64_t>(sweep.samples.size());
    vector<std::int64_t> chosen;
    if (n_samples >= size) {
        for (std::int64_t i = 0; i < size; ++i) chosen.push_back(i);
        return chosen;
    }
    if (n_samples == 1) {
        chosen.push_back(position_at_rest(sweep));
        return chosen;
    }
    for (std::int64_t i = 0; i < n_samples; ++i) {
        const double n = static_cast<double>(n_samples), s = static_cast<double>(size),
                     x = static_cast<double>(i);
        const double position = with_ends ? std::round(x * (s - 1) / (n - 1)) : std::floor((x + 0.5) * s / n);
        const std::int64_t index = std::min(size - 1, static_cast<std::int64_t>(position));
        if (chosen.empty() || chosen.back() != index) chosen.push_back(index);
    }
    return chosen;
}

std::vector<SelectedSample> select_samples(const std::vector<ContactSweep> &sweeps, std::int64_t n_samples,
                                           bool with_ends, bool complements, bool with_rest) {
    std::vector<SelectedSample> samples;
    for (std::size_t d = 0; d < sweeps.size(); ++d) {
        vector<std::int64_t> chosen = equally_spaced(sweeps[d], n_samples, with_ends);
        if (with_rest && sweeps[d].offset_is_rest) move_nearest(chosen, position_at_rest(sweeps[d]));
        for (std::int64_t i : chosen)
            add_unless_present(samples, {sweeps[d].samples[i], static_cast<std::int64_t>(d), i, false});
    }
    const std::size_t n_selected = complements ? samples.size() : 0;
    for (std::size_t i = 0; i < n_selected; ++i) {
        const SelectedSample &s = samples[i];
        add_unless_present(samples, {s.states.inverted(), s.dominant, s.sweep_index, true});
    }
    return samples;
}

} // namespace plm
