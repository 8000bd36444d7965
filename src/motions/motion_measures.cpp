#include "motions/motion_measures.hpp"
#include "contact/contact_force.hpp"
#include "contact/contact_measures.hpp"
#include "motions/penetration.hpp"
#include "reduction/reduced_rest.hpp"
#include "structure/driven_harmonic.hpp"
#include <algorithm>

namespace plm {
namespace {

// Static part: strain, contact and load of (eta, u) at rest.
double rest_energy(const ReducedModel &m) {
    if (!is_loaded_at_rest(m)) return 0;
    const StaticState &rest = *rest_of(m);
    double energy = -dot(m.static_size(), m.preload_0.data(), rest.coordinates.data());
    for (std::int64_t j = 0; j < m.static_size(); ++j)
        energy += 0.5 * m.lambda_0[j] * rest.coordinates[j] * rest.coordinates[j];
    for (std::int64_t i = 0; i < m.n_pairs(); ++i) energy += m.contact.energy(i, rest.penetration[i]);
    return energy;
}

void measure_contact(const ReducedModel &m, const BranchPoint &point, MotionMeasures &out) {
    const std::int64_t z = m.n_pairs();
    if (z == 0) return;
    const Matrix u = penetration_of(m, point, point.eta.cols() / 2);
    const ContactMotion law = contact_motion(m, point);
    Matrix v(z, u.cols());
    std::copy(law.u.data(), law.u.data() + z * std::min(u.cols(), law.u.cols()), v.data());
    ContactIndicator s;
    make_event_force(v.cols() / 2, z)->indicator(v, s);
    Matrix force;
    apply_indicator(s, *law.stiffness, v, force);
    out.contact = mean_energy(force, u);
    if (m.all_pairs) { // the energy is that of the equations, the area that of the surface
        const Matrix all = whole_contact_motion(m, point).u;
        make_event_force(all.cols() / 2, all.rows())->indicator(all, s);
    }
    out.closed_share = s.closed_share();
    if (!point.motion || m.all_pairs || z == 0) return;
    out.closed_share = 0; // known without the harmonics
    for (double share : point.motion->closed_shares()) out.closed_share += share / static_cast<double>(z);
}

} // namespace

MotionMeasures measure_motion(const ReducedModel &m, const BranchPoint &point, std::int64_t period_multiple) {
    MotionMeasures out;
    for (std::int64_t j = 0; j < m.static_size(); ++j) {
        out.strain += 0.5 * m.lambda_0[j] * point.eta_0[j] * point.eta_0[j];
        out.load -= m.preload_0[j] * point.eta_0[j];
    }
    for (std::int64_t c = 0; c < point.eta.cols(); ++c) {
        const double h = static_cast<double>(c / 2 + 1),
                     w = h * point.omega / static_cast<double>(period_multiple);
        for (std::int64_t j = 0; j < m.size(); ++j) {
            const double square = point.eta(j, c) * point.eta(j, c);
            out.kinetic += 0.25 * w * w * m.mass(j) * square;
            out.strain += 0.25 * m.lambda[j] * square;
        }
    }
    measure_contact(m, point, out);
    out.total = out.kinetic + out.strain + out.contact + out.load - rest_energy(m);
    return out;
}

namespace {

// Rigid-body motion beside the contact falls with the square of the frequency, and would draw the search
// down.
vector<char> held_coordinates(const ReducedModel &m, double omega) {
    constexpr double rigid = 1e-6,
                     unmoved = 1e-9; // what rounding leaves of a rigid-body mode, of a row of gaps
    double largest = 0;
    for (std::int64_t k = 0; k < m.gap.rows() * m.gap.cols(); ++k)
        largest = std::max(largest, std::abs(m.gap.data()[k]));
    vector<char> held(m.size());
    for (std::int64_t j = 0; j < m.size(); ++j) {
        double moved = 0;
        for (std::int64_t i = 0; i < m.n_pairs(); ++i) moved = std::max(moved, std::abs(m.gap(i, j)));
        held[j] = m.lambda[j] > rigid * omega * omega || moved > unmoved * largest;
    }
    return held;
}

} // namespace

double response_size(const Branch &branch, std::int64_t point) {
    const BranchPoint &p = branch.points()[static_cast<std::size_t>(point)];
    const vector<char> held = held_coordinates(branch.reduced(), p.omega);
    double sum = 0;
    for (std::int64_t c = 0; c < p.eta.cols(); ++c)
        for (std::int64_t j = 0; j < p.eta.rows(); ++j)
            if (held[j]) sum += p.eta(j, c) * p.eta(j, c);
    return std::sqrt(sum);
}

std::int64_t largest_response(const Branch &branch) {
    std::int64_t best = 0;
    double most = -1;
    for (std::size_t i = 0; i < branch.points().size(); ++i) {
        const double size = response_size(branch, static_cast<std::int64_t>(i));
        if (size > most) most = size, best = static_cast<std::int64_t>(i);
    }
    return best;
}

double phase_of(const ReducedModel &m, const BranchPoint &point, std::int64_t period_multiple) {
    const int driven = driven_harmonic(m.excitation);
    if (driven == 0) return 0;
    const std::int64_t h = driven * period_multiple;
    if (2 * h > point.eta.cols()) return 0;
    const HarmonicLoad load = load_at(m.excitation, driven, point.omega);
    // q = a - i b and F = F_r + i F_i: Re(F^H q) = F_r . a - F_i . b
    return dot(m.size(), load.real.data(), point.eta.col(2 * h - 2)) -
           dot(m.size(), load.imag.data(), point.eta.col(2 * h - 1));
}

Output most_moving(const Branch &branch, std::int64_t point) {
    const Model &model = *branch.reduced().model;
    Output most;
    double largest = -1;
    for (double fraction : {0.0, 0.25}) { // half a period apart, twice
        const vector<double> one = model.expanded(branch.field(point, fraction)),
                             other = model.expanded(branch.field(point, fraction + 0.5));
        for (std::size_t i = 0; i < one.size(); ++i)
            if (std::abs(one[i] - other[i]) > largest)
                largest = std::abs(one[i] - other[i]), most.dof = static_cast<std::int64_t>(i);
    }
    return most;
}

vector<std::int64_t> spread_over(const Branch &branch, std::int64_t wanted) {
    const std::int64_t points = static_cast<std::int64_t>(branch.points().size()),
                       n = std::min(points, wanted);
    vector<std::int64_t> at;
    for (std::int64_t k = 0; k < n; ++k) at.push_back(n > 1 ? k * (points - 1) / (n - 1) : 0);
    return at;
}

} // namespace plm
