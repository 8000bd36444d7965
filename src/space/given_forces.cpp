#include "space/given_forces.hpp"
#include <algorithm>
#include <limits>

namespace plm {

bool GivenForces::empty() const {
    return std::all_of(force.begin(), force.end(), [](double n) { return n == keep_gap; });
}

Contact GivenForces::without_them(const Contact &contact) const {
    Contact others;
    others.stiffness = contact.stiffness, others.initial_gap = contact.initial_gap;
    for (std::int64_t i = 0; i < contact.n_pairs(); ++i)
        if (has(i)) others.initial_gap[i] = std::numeric_limits<double>::infinity();
    return others;
}

vector<double> GivenForces::loads(std::int64_t n) const {
    vector<double> loads(static_cast<std::size_t>(n), 0.0);
    put_forces(loads);
    return loads;
}

void GivenForces::put_penetrations(const Contact &contact, vector<double> &penetration) const {
    for (std::int64_t i = 0; i < contact.n_pairs(); ++i)
        if (has(i)) penetration[i] = force[i] / contact.stiffness[i];
}

void GivenForces::put_forces(vector<double> &forces) const {
    for (std::size_t i = 0; i < forces.size(); ++i)
        if (has(static_cast<std::int64_t>(i))) forces[i] = force[i];
}

} // namespace plm
