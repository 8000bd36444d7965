#include "row.hpp"
#include "dense.hpp"
#include <algorithm>
#include <cmath>

namespace extreme {
namespace {

// Within two points of where the frequency turns: truncated motions go on there a little beyond the exact
// ones, and at such a frequency the nearest exact motion is that of another branch.
bool is_beside_fold(const std::vector<double> &omega, std::size_t i) {
    for (std::size_t k = std::max<std::size_t>(i, 3) - 2; k <= i + 2 && k + 1 < omega.size(); ++k)
        if ((omega[k] - omega[k - 1]) * (omega[k + 1] - omega[k]) < 0) return true;
    return false;
}

// Indices spread evenly over the curve, away from its folds, and its highest point.
std::vector<std::size_t> spread(const std::vector<double> &omega, const std::vector<double> &amplitude,
                                int n) {
    std::vector<std::size_t> chosen;
    const std::size_t size = amplitude.size();
    for (int k = 0; k < n - 1; ++k) {
        std::size_t i = std::min(size - 1, (2 * k + 1) * size / (2 * (n - 1)));
        while (i + 1 < size && is_beside_fold(omega, i)) ++i;
        chosen.push_back(i);
    }
    chosen.push_back(std::max_element(amplitude.begin(), amplitude.end()) - amplitude.begin());
    return chosen;
}

// Of the exact orbits found from the curve's state at once and after marching, the nearest.
double error_at_point(const exact::Structure &s, const Curve &curve,
                      const std::vector<std::vector<double>> &amplitude, std::size_t i, int samples) {
    double best = 1e300;
    for (int periods : {0, 60}) {
        const exact::Orbit orbit =
            exact::periodic_orbit(s, curve.omega[i], curve.state(i, s.n), periods, samples);
        if (!orbit.converged) continue;
        double error = 0, size = 0;
        for (int dof = 0; dof < s.n; ++dof) {
            error = std::max(error, std::abs(amplitude[dof][i] - orbit.peak(dof)));
            size = std::max(size, orbit.peak(dof));
        }
        best = std::min(best, error / size);
        if (best < 0.1) break;
    }
    return best;
}

} // namespace

Measured outcome_of(const Curve &curve) {
    Measured m;
    m.reason = curve.end_reason;
    m.outcome = curve.end_text;
    m.unknowns = curve.unknowns;
    m.work = curve.work;
    return m;
}

OrbitErrors orbit_errors(const exact::Structure &s, const Curve &curve, int n_points, int samples) {
    std::vector<std::vector<double>> amplitude;
    for (int dof = 0; dof < s.n; ++dof) amplitude.push_back(curve.amplitude(dof));
    OrbitErrors errors;
    for (std::size_t i : spread(curve.omega, amplitude[s.n - 1], n_points)) {
        const double error = error_at_point(s, curve, amplitude, i, samples);
        if (error < 1e300) {
            errors.worst = std::max(errors.worst, error);
        } else {
            ++errors.missing;
        }
    }
    return errors;
}

double orbit_error(const exact::Structure &s, const Curve &curve, int n_points, int samples) {
    const OrbitErrors errors = orbit_errors(s, curve, n_points, samples);
    return errors.missing > 0 ? 1e300 : errors.worst;
}

double linear_error(const exact::Structure &s, const std::vector<bool> &closed, const Curve &curve, int dof,
                    const std::vector<double> *full_mass) {
    const std::vector<double> amplitude = curve.amplitude(dof);
    double worst = 0;
    for (std::size_t i = 0; i < amplitude.size(); ++i)
        worst = std::max(worst,
                         std::abs(amplitude[i] / linear_peak(s, closed, curve.omega[i], dof, full_mass) - 1));
    return worst;
}

} // namespace extreme
