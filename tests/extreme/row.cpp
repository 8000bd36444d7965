#include "row.hpp"
#include "dense.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace extreme {
namespace {

// Indices spread evenly over the curve, and its highest point.
std::vector<std::size_t> spread(const std::vector<double> &amplitude, int n) {
    std::vector<std::size_t> chosen;
    const std::size_t size = amplitude.size();
    for (int k = 0; k < n - 1; ++k)
        chosen.push_back(std::min(size - 1, (2 * k + 1) * size / (2 * (n - 1))));
    chosen.push_back(std::max_element(amplitude.begin(), amplitude.end()) - amplitude.begin());
    return chosen;
}

} // namespace

Measured outcome_of(const Curve &curve) {
    Measured m;
    m.reason = curve.end_reason;
    m.outcome = curve.end_text;
    m.work = curve.work;
    return m;
}

double orbit_error(const exact::Structure &s, const Curve &curve, int dof, int n_points, int samples) {
    const std::vector<double> amplitude = curve.amplitude(dof);
    double worst = 0;
    for (std::size_t i : spread(amplitude, n_points)) {
        const exact::Orbit orbit =
            exact::periodic_orbit(s, curve.omega[i], curve.state(i, s.n), 0, samples);
        const double error = orbit.converged ? std::abs(amplitude[i] / orbit.peak(dof) - 1) : 1e300;
        if (std::getenv("EXTREME_DETAIL"))
            std::fprintf(stderr, "    omega %.6f amplitude %.9g exact %.9g %s\n", curve.omega[i], amplitude[i],
                         orbit.peak(dof), orbit.converged ? "" : "NO ORBIT");
        if (!orbit.converged) return error;
        worst = std::max(worst, error);
    }
    return worst;
}

double linear_error(const exact::Structure &s, const std::vector<bool> &closed, const Curve &curve, int dof,
                    const std::vector<double> *full_mass) {
    const std::vector<double> amplitude = curve.amplitude(dof);
    double worst = 0;
    for (std::size_t i = 0; i < amplitude.size(); ++i)
        worst = std::max(
            worst, std::abs(amplitude[i] / linear_peak(s, closed, curve.omega[i], dof, full_mass) - 1));
    return worst;
}

} // namespace extreme
