// Samples that nearly coincide: their modes are nearly the same vectors, and the basis must be conditioned.
#include "row.hpp"
#include "structures.hpp"
#include <algorithm>
#include <cmath>

namespace extreme {
namespace {

constexpr int length = 120;

// 120 masses with a pair at every tenth one.
exact::Structure long_chain(double ratio) {
    std::vector<int> pairs;
    for (int p = 9; p < length; p += 10) pairs.push_back(p);
    exact::Structure s = chain(length, 0.02, pairs);
    set_contact(s, ratio * local_stiffness(s), 0);
    s.preload[length - 1] = 0.5;
    s.preload[45] = -0.6; // some pairs are open at rest
    return s;
}

// Curve on piecewise-linear modes against the unreduced one: height and frequency of the resonance.
Measured against_full(const exact::Structure &s, const std::map<std::string, std::int64_t> &options, bool sampled) {
    Setup setup;
    setup.low = 0.008, setup.high = 0.035;
    setup.sampled = sampled;
    Setup full = setup;
    setup.kind = "plm";
    setup.sampler = options;
    Solver reduced(s, setup), unreduced(s, full);
    const auto curve = reduced.sweep(), truth = unreduced.sweep();
    Measured m = outcome_of(*curve);
    const auto got = reduced.peak(*curve, length - 1), want = unreduced.peak(*truth, length - 1);
    m.error = std::max(std::abs(got.first / want.first - 1), std::abs(got.second / want.second - 1));
    m.outcome += ", r = " + std::to_string(reduced.basis_size());
    return m;
}

} // namespace

std::vector<Row> basis_rows() {
    std::vector<Row> rows;
    const std::map<std::string, std::int64_t> all = {{"n_samples", 1000}};
    rows.push_back({"samples-all", "120 masses, 12 pairs, all samples of the sweep, k_n = 10 k_loc",
                    "unreduced peak", 1e-4, true, [=](bool sampled) { return against_full(long_chain(10), all, sampled); }});
    rows.push_back({"samples-soft", "the same, k_n = 1e-6 k_loc: all samples coincide to 1e-6", "unreduced peak",
                    1e-6, true, [=](bool sampled) { return against_full(long_chain(1e-6), all, sampled); }});
    rows.push_back({"samples-softer", "the same, k_n = 1e-12 k_loc: all samples coincide to 1e-12",
                    "unreduced peak", 1e-6, true,
                    [=](bool sampled) { return against_full(long_chain(1e-12), all, sampled); }});
    return rows;
}

} // namespace extreme
