#include "sampling/contact_sweep.hpp"
#include "contact/contact_law.hpp"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace plm {
namespace {

// Thresholds this close are one: twins of a symmetric mesh, whose eigenvectors and gaps are symmetric to
// rounding times the condition, not to rounding. A set of one of two twins alone would be noise.
constexpr double tie = 1e-6;

struct Switch {
    double alpha;
    std::int64_t pair;
};

vector<Switch> find_switches(const vector<double> &offset, const vector<double> &dv) {
    double largest = 0;
    for (double v : dv) largest = std::max(largest, std::abs(v));
    vector<Switch> switches;
    for (std::size_t i = 0; i < dv.size(); ++i)
        if (largest > 0 && std::abs(dv[i]) >= unmoved * largest)
            switches.push_back(
                {-offset[i] / dv[i] + 0.0, static_cast<std::int64_t>(i)}); // + 0.0: no negative zero
    std::stable_sort(switches.begin(), switches.end(),
                     [](const Switch &a, const Switch &b) { return a.alpha < b.alpha; });
    return switches;
}

// The size of a typical threshold. Not their range: one pair that hardly moves would stretch it at will.
double typical_size(const vector<Switch> &switches) {
    vector<double> size;
    for (const Switch &s : switches) size.push_back(std::abs(s.alpha));
    if (size.empty()) return 0;
    std::nth_element(size.begin(), size.begin() + size.size() / 2, size.end());
    return size[size.size() / 2];
}

void group_switches(const vector<Switch> &switches, ContactSweep &sweep) {
    const double typical = typical_size(switches);
    for (std::size_t i = 0; i < switches.size();) {
        const double first = switches[i].alpha;
        double sum = 0;
        vector<std::int64_t> pairs;
        for (; i < switches.size(); ++i) {
            const double size = std::max({std::abs(first), std::abs(switches[i].alpha), typical});
            if (switches[i].alpha - first > tie * size) break;
            sum += switches[i].alpha;
            pairs.push_back(switches[i].pair);
        }
        sweep.thresholds.push_back(sum / static_cast<double>(pairs.size()));
        sweep.switching.push_back(std::move(pairs));
    }
}

// Status of every pair below the lowest threshold.
vector<char> first_sample(const vector<double> &offset, const vector<double> &dv,
                          const vector<Switch> &switches) {
    vector<char> closed(offset.size());
    for (std::size_t i = 0; i < offset.size(); ++i) closed[i] = ContactLaw::closed(offset[i]);
    for (const Switch &s : switches) closed[s.pair] = dv[s.pair] < 0;
    return closed;
}

vector<double> representative_alphas(const vector<double> &thresholds) {
    if (thresholds.empty()) return vector<double>(1, 0.0);
    const double first = thresholds.front(), last = thresholds.back();
    double margin = 0.05 * (last - first);
    if (!(margin > 0)) margin = first != 0 ? 0.05 * std::abs(first) : 1.0;
    vector<double> alpha;
    alpha.push_back(first - margin);
    for (std::size_t i = 1; i < thresholds.size(); ++i)
        alpha.push_back(0.5 * (thresholds[i - 1] + thresholds[i]));
    alpha.push_back(last + margin);
    return alpha;
}

SelectedSample make_sample(vector<char> closed, std::int64_t dominant, std::int64_t index, bool complement) {
    SelectedSample s;
    s.n_closed = std::count_if(closed.begin(), closed.end(), [](char c) { return c != 0; });
    s.closed = std::move(closed);
    s.dominant = dominant;
    s.sweep_index = index;
    s.complement = complement;
    return s;
}

void add_unless_present(std::vector<SelectedSample> &samples, SelectedSample sample) {
    for (const SelectedSample &s : samples)
        if (s.closed == sample.closed) return;
    samples.push_back(std::move(sample));
}

// The ends stay where they are as long as there is an inner position to move.
void move_nearest(vector<std::int64_t> &chosen, std::int64_t target) {
    if (chosen.empty() || std::find(chosen.begin(), chosen.end(), target) != chosen.end()) return;
    const bool inner = chosen.size() > 2;
    *std::min_element(chosen.begin() + inner, chosen.end() - inner, [&](std::int64_t a, std::int64_t b) {
        return std::abs(a - target) < std::abs(b - target);
    }) = target;
    std::sort(chosen.begin(), chosen.end());
}

} // namespace

ContactSweep sweep_contact(const vector<double> &offset, bool offset_is_rest, const vector<double> &dv) {
    ContactSweep sweep;
    sweep.offset = offset;
    sweep.offset_is_rest = offset_is_rest;
    const vector<Switch> switches = find_switches(offset, dv);
    group_switches(switches, sweep);
    sweep.samples.push_back(first_sample(offset, dv, switches));
    for (const auto &pairs : sweep.switching) { // toggled, not evaluated: exact at ties
        vector<char> closed = sweep.samples.back();
        for (std::int64_t i : pairs) closed[i] = !closed[i];
        sweep.samples.push_back(std::move(closed));
    }
    sweep.alpha = representative_alphas(sweep.thresholds);
    return sweep;
}

std::int64_t position_at_rest(const ContactSweep &sweep) {
    return std::upper_bound(sweep.thresholds.begin(), sweep.thresholds.end(), 0.0) - sweep.thresholds.begin();
}

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
            add_unless_present(samples,
                               make_sample(sweeps[d].samples[i], static_cast<std::int64_t>(d), i, false));
    }
    const std::size_t n_selected = complements ? samples.size() : 0;
    for (std::size_t i = 0; i < n_selected; ++i) {
        vector<char> inverted = samples[i].closed;
        for (char &c : inverted) c = !c;
        add_unless_present(
            samples, make_sample(std::move(inverted), samples[i].dominant, samples[i].sweep_index, true));
    }
    return samples;
}

} // namespace plm
