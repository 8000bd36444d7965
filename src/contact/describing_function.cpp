#include "contact/describing_function.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

double closed_half_angle(double mean, double amplitude) {
    const double a = std::abs(amplitude);
    if (std::abs(mean) >= a) return ContactLaw::closed(mean) ? M_PI : 0.0;
    return std::acos(-mean / a);
}

double force_coefficient(double stiffness, double mean, double amplitude, std::int64_t h) {
    const double theta = closed_half_angle(mean, amplitude), a = std::abs(amplitude);
    const double n = static_cast<double>(h);
    if (h == 0) return stiffness / M_PI * (mean * theta + a * std::sin(theta));
    const double below = h == 1 ? theta : std::sin((n - 1) * theta) / (n - 1);
    const double moving = 0.5 * a * (below + std::sin((n + 1) * theta) / (n + 1));
    const double value = 2 * stiffness / M_PI * (mean * std::sin(n * theta) / n + moving);
    return amplitude < 0 && h % 2 != 0 ? -value : value;
}

double mean_tangent(double stiffness, double mean, double amplitude) {
    return stiffness * closed_half_angle(mean, amplitude) / M_PI;
}

double equivalent_stiffness(double stiffness, double mean, double amplitude) {
    if (amplitude == 0) return ContactLaw::tangent(stiffness, mean);
    const double value = force_coefficient(stiffness, mean, amplitude, 1) / amplitude;
    return std::min(std::max(value, 0.0), stiffness); // rounding
}

} // namespace plm
