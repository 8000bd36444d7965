#include "structure/mode_count.hpp"
#include "linalg/scale.hpp"
#include <cmath>

namespace plm {

std::int64_t count_modes(const TallMatrix &k, const TallMatrix &m, double omega, const Solver &solver) {
    if (!solver.tells_inertia()) return cannot_tell_count;
    try {
        return k.count_negative(-omega * omega, m, solver);
    } catch (const Error &e) {
        if (e.status() != status::singular) throw;
        return hit_a_mode;
    }
}

std::int64_t count_modes_near(const TallMatrix &k, const TallMatrix &m, double &omega, const Solver &solver,
                              const char *which, const char *remedy, Watch watch) {
    constexpr int attempts = 4;
    constexpr double aside = 1.003; // out of reach of the mode, and hardly another frequency
    std::int64_t count = hit_a_mode;
    for (int attempt = 0; attempt < attempts && count == hit_a_mode; ++attempt) {
        if (attempt > 0) omega *= aside;
        watch.step("count of modes", 0.1);
        count = count_modes(k, m, omega, solver);
    }
    if (count == hit_a_mode)
        watch.warn(
            reason::unverified,
            format("the number of %s below %.6g Hz could not be verified: K - w^2 M is singular there and "
                   "just above; compare with another %s",
                   which, omega / (2 * M_PI), remedy));
    return count;
}

} // namespace plm
