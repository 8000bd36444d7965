// Samples that nearly coincide: their modes are nearly the same vectors, and the basis must be conditioned.
#include "row.hpp"
#include "structures.hpp"
#include <algorithm>
#include <cmath>

namespace extreme {
namespace {

constexpr int length = 40;
using Options = std::map<std::string, std::int64_t>;
const Options all_samples = {{"n_samples", 1000}};

// 40 masses with a pair at every tenth one.
exact::Structure long_chain(double ratio) {
    exact::Structure s = chain(length, 0.05, {9, 19, 29, 39});
    set_contact(s, ratio * local_stiffness(s), 0);
    s.preload[length - 1] = 0.5;
    s.preload[15] = -0.6; // some pairs are open at rest
    return s;
}

Setup setup_of(bool reduced, bool sampled) {
    Setup setup;
    setup.low = 0.024, setup.high = 0.1;
    setup.sampled = sampled;
    if (reduced) setup.kind = "plm", setup.sampler = all_samples;
    return setup;
}

// Height and frequency of the resonance against those of the same solver without reduction: the error is the
// basis'.
Measured against_full(double ratio, bool sampled) {
    const exact::Structure s = long_chain(ratio);
    Solver reduced(s, setup_of(true, sampled)), unreduced(s, setup_of(false, sampled));
    const auto curve = reduced.sweep(), truth = unreduced.sweep();
    Measured m = outcome_of(*curve);
    const auto got = reduced.peak(*curve, length - 1), want = unreduced.peak(*truth, length - 1);
    m.error = std::max(std::abs(got.first / want.first - 1), std::abs(got.second / want.second - 1));
    m.outcome += ", r = " + std::to_string(reduced.basis_size());
    return m;
}

// Contact so soft that it is nothing: every point against the linear answer.
Measured against_nothing(double ratio, bool sampled) {
    const exact::Structure s = long_chain(ratio);
    Solver reduced(s, setup_of(true, sampled));
    const auto curve = reduced.sweep();
    Measured m = outcome_of(*curve);
    m.error = linear_error(s, std::vector<bool>(s.z, false), *curve, length - 1);
    m.outcome += ", r = " + std::to_string(reduced.basis_size());
    return m;
}

} // namespace

std::vector<Row> basis_rows() {
    std::vector<Row> rows;
    rows.push_back({"samples-all",
                    "40 masses, 4 pairs, pre-load, all samples of the sweep, PLM basis, k_n = k_loc",
                    "unreduced peak", 1e-4, true, [](bool sampled) { return against_full(1, sampled); }});
    rows.push_back({"samples-soft", "the same, k_n = 1e-6 k_loc: all samples coincide to 1e-6",
                    "unreduced peak", 1e-5, true, [](bool sampled) { return against_full(1e-6, sampled); }});
    rows.push_back({"samples-softer", "the same, k_n = 1e-12 k_loc: all samples coincide to 1e-12",
                    "linear answer", 1e-5, true,
                    [](bool sampled) { return against_nothing(1e-12, sampled); }});
    return rows;
}

} // namespace extreme
