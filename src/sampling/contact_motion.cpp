#include "sampling/contact_motion.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Of every pair in the open structure: the sum of g^2 / (lambda + omega^2 m).
vector<double> flexibility(const Space &space, double omega) {
    vector<double> a(static_cast<std::size_t>(space.n_pairs()), 0.0);
    for (std::int64_t j = 0; j < space.size(); ++j) {
        const double stiffness = space.lambda[j] + space.mass(j) * omega * omega, *gap = space.gap.col(j);
        for (std::size_t i = 0; i < a.size(); ++i) a[i] += gap[i] / stiffness * gap[i];
    }
    return a;
}

} // namespace

double contact_motion(const Space &space, const vector<double> &mode_penetration, double omega) {
    const vector<double> a = flexibility(space, omega);
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i] > 0) most = std::max(most, std::abs(mode_penetration[i]) / (omega * std::sqrt(a[i])));
    return most;
}

double contact_share(const Space &space, const vector<double> &mode_penetration, double omega,
                     const vector<double> &spring) {
    const vector<double> a = flexibility(space, omega);
    vector<double> released(mode_penetration);
    for (std::size_t i = 0; i < a.size(); ++i) released[i] *= 1 + spring[i] * a[i];
    return std::min(1.0, contact_motion(space, released, omega));
}

} // namespace plm
