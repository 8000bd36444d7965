#include "hbm/modes_at_rest.hpp"
#include "hbm/make_system.hpp"
#include "reduction/reduced_rest.hpp"
#include "space/linear_contact.hpp"
#include "structure/driven_harmonic.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm {

SpaceModes modes_at_rest(const ReducedModel &m, const vector<double> &coupling) {
    vector<double> spring(coupling);
    for (std::int64_t i = 0; i < m.n_pairs(); ++i) spring[i] *= m.contact.stiffness[i];
    return modes_with_springs(m.lambda, m.n_massless, m.gap, spring, std::numeric_limits<double>::infinity());
}

namespace {

// The start of a backbone, at rest: of the force at which the first pair switches, of the force asked for;
// and what is so much smaller than that that the pair switches at any force.
constexpr double before_switching = 0.5, small_force = 0.1, no_force = 1e-9;

// A force at which no pair changes its state yet. False when there is none: pairs that touch without
// pressure.
bool linear_range(const ReducedModel &m, double asked, const vector<double> &coupling,
                  const BranchPoint &point, double &force) {
    double largest = 1e300;
    vector<double> mean = m.contact.unloaded_penetration();
    if (m.n_pairs() > 0) gemv('N', 1.0, m.gap_0, point.eta_0.data(), 1.0, mean.data());
    const Matrix u = product('N', 'N', m.gap, point.eta);
    double most = 0;
    for (std::int64_t i = 0; i < m.n_pairs(); ++i) {
        double swing = 0;
        for (std::int64_t c = 0; c < u.cols(); ++c) swing = std::hypot(swing, u(i, c));
        if (swing > 0)
            largest = std::min(largest, coupling[i] == 0.5 ? 0.0 : asked * std::abs(mean[i]) / swing);
        most = std::max(most, swing);
    }
    force = std::min(before_switching * largest, small_force * asked);
    return force > no_force * asked;
}

} // namespace

std::vector<BranchPoint> linear_resonances(std::shared_ptr<const ReducedModel> reduced,
                                           const HbmOptions &options) {
    const ReducedModel &m = *reduced;
    const vector<double> coupling = coupling_at_rest(m);
    const int driven = driven_harmonic(m.excitation);
    if (driven == 0 || driven > options.n_harmonics) return {};
    const vector<double> lambda = modes_at_rest(m, coupling).values;
    const auto system = make_system(reduced, options);
    std::vector<BranchPoint> points;
    vector<double> x(system->size());
    for (double l : lambda) {
        const double omega = std::sqrt(std::max(0.0, l)) / driven;
        if (omega < 2 * M_PI * options.frequency_min_hz || omega > 2 * M_PI * options.frequency_max_hz)
            continue;
        system->linear_response(coupling, omega, x.data());
        BranchPoint point;
        system->to_point(x.data(), omega, point);
        double force = 0;
        if (!linear_range(m, options.force_scale, coupling, point, force)) continue;
        for (std::int64_t i = 0; i < point.eta.cols() * m.size(); ++i)
            point.eta.data()[i] *= force / point.force_scale;
        point.force_scale = force;
        points.push_back(std::move(point));
    }
    return points;
}

} // namespace plm
