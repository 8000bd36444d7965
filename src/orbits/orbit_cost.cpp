#include "orbits/orbit_cost.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

// Every pair switches a few times in a period, and each event costs a product with the propagator of its
// contact set, now and then the modes of a new one, and some pieces of the flow.
double exact_step_flops(const ReducedModel &m, const MotionOptions &o) {
    // measured at 37 coordinates and 15 pairs, 47 and 90, 110 and 32: 6, 84 and 100 ms at 3 Gflop/s
    constexpr double events_per_pair = 3, pieces_per_event = 5, terms = 6, cubes = 2;
    constexpr double least_piece = 3e4; // what a piece of the smallest system takes, in time
    const double n = static_cast<double>(m.static_size()), z = static_cast<double>(m.n_pairs()),
                 events = events_per_pair * z * static_cast<double>(o.period_multiple),
                 per_event = cubes * n * n * n, per_piece = least_piece + 4 * terms * n * (n + z);
    return events * (per_event + pieces_per_event * per_piece);
}

bool has_flow(const ReducedModel &m) {
    return m.structural == 0 && (m.damping.empty() || !decays_hopelessly(m));
}

bool decays_hopelessly(const ReducedModel &m) {
    constexpr double terms = 26, radians = 2;
    constexpr double hopeless_period = 3e9; // flops: a curve takes many minutes
    const auto slowest = std::find_if(m.lambda.begin(), m.lambda.end(), [](double l) { return l > 0; });
    if (slowest == m.lambda.end()) return false;
    double rate = 0;
    for (std::int64_t j = 0; j < m.size() - m.n_massless; ++j)
        rate = std::max(rate, m.damping.empty() ? m.damping_diagonal[j] : m.damping(j, j));
    const double n = static_cast<double>(m.size()), z = static_cast<double>(m.n_pairs()),
                 pieces = rate * 2 * M_PI / std::sqrt(*slowest) / radians;
    return in_series * pieces * terms * 2 * n * (n + z) > hopeless_period;
}

} // namespace plm
