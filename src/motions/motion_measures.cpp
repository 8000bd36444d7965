#include "motions/motion_measures.hpp"
#include "contact/contact_force.hpp"
#include "contact/contact_measures.hpp"
#include "motions/penetration.hpp"
#include "reduction/reduced_rest.hpp"
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

} // namespace plm
