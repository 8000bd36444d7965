#include "sampling/contact_motion.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

double contact_motion(const Space &space, const vector<double> &mode_penetration, double omega) {
    vector<double> reach(mode_penetration.size(), 0.0);
    for (std::int64_t j = 0; j < space.size(); ++j) {
        const double moved = omega / std::sqrt(space.lambda[j] + space.mass(j) * omega * omega);
        const double *gap = space.gap.col(j);
        for (std::size_t i = 0; i < reach.size(); ++i)
            reach[i] = std::max(reach[i], moved * std::abs(gap[i]));
    }
    double most = 0;
    for (std::size_t i = 0; i < reach.size(); ++i)
        if (reach[i] > 0) most = std::max(most, std::abs(mode_penetration[i]) / reach[i]);
    return most;
}

} // namespace plm
