#include "contact/contact_sweep.hpp"
#include <algorithm>
#include <cmath>
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
PairStates first_sample(const vector<double> &offset, const vector<double> &dv,
                        const vector<Switch> &switches) {
    PairStates states = states_at(offset);
    for (const Switch &s : switches) states.set(s.pair, dv[s.pair] < 0);
    return states;
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

} // namespace

ContactSweep sweep_contact(const vector<double> &offset, bool offset_is_rest, const vector<double> &dv) {
    ContactSweep sweep;
    sweep.offset = offset;
    sweep.offset_is_rest = offset_is_rest;
    const vector<Switch> switches = find_switches(offset, dv);
    group_switches(switches, sweep);
    sweep.samples.push_back(first_sample(offset, dv, switches));
    for (const auto &pairs : sweep.switching) { // toggled, not evaluated: exact at ties
        PairStates states = sweep.samples.back();
        for (std::int64_t i : pairs) states.switch_pair(i);
        sweep.samples.push_back(std::move(states));
    }
    sweep.alpha = representative_alphas(sweep.thresholds);
    return sweep;
}

std::int64_t position_at_rest(const ContactSweep &sweep) {
    return std::upper_bound(sweep.thresholds.begin(), sweep.thresholds.end(), 0.0) - sweep.thresholds.begin();
}

} // namespace plm
