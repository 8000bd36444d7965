#include "sampling/reference_system.hpp"
#include "contact/contact_sweep.hpp"
#include "sampling/contact_motion.hpp"
#include "sampling/mode_match.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm {
namespace {

// How much better the sliding system has to be: nearly equal ones are a matter of rounding.
constexpr double clearly = 1.1;

bool proposes(const ModeRequest &request) {
    return request.mode == 0 && request.frequency_hz == 0;
}

bool contact_holds_a_part(const Space &space) {
    double largest = 0, rigid = 0;
    for (std::int64_t j = 0; j < space.size(); ++j)
        for (std::int64_t i = 0; i < space.n_pairs(); ++i) {
            const double size = std::abs(space.gap(i, j));
            largest = std::max(largest, size);
            if (space.lambda[j] == 0) rigid = std::max(rigid, size);
        }
    return rigid > unmoved * largest;
}

// Modes that the closed pairs of a linear system leave without stiffness.
std::int64_t n_loose(const Space &space, const PairStates &states) {
    const auto elastic = std::upper_bound(space.lambda.begin(), space.lambda.end(), 0.0);
    const double upper = elastic == space.lambda.end() ? std::numeric_limits<double>::infinity() : *elastic;
    const SpaceModes modes = modes_of_contact_set(space, states, upper);
    return std::count(modes.values.begin(), modes.values.end(), 0.0);
}

// Where parts float while the contacts are open: what holds them. Closed contact at rest, if it holds as much
// as contact can; all of it, if nothing could vibrate else.
LinearSystem holding_system(const Space &space, const RestState &rest) {
    if (rest.states.n_closed() > 0 &&
        n_loose(space, rest.states) == n_loose(space, contact_set(LinearSystem::sliding, space)))
        return LinearSystem::rest;
    return space.n_massive() > 0 && space.lambda[space.n_massive() - 1] > 0 ? LinearSystem::open
                                                                            : LinearSystem::sliding;
}

double agreement_of_half(const Space &space, const DominantMode &dominant, double side) {
    const Contact &contact = space.model->contact();
    vector<double> half(dominant.mode_penetration);
    for (double &u : half) u *= side;
    const PairStates states = contact.states(half);
    const double omega = 2 * M_PI * dominant.frequency_hz;
    const MatchedModes found = match_modes(space, states, dominant.coordinates, 9 * omega * omega);
    if (found.best < 0) return 0;
    const double *mode = found.modes.vectors.col(found.best);
    const double along = dot(space.size(), mode, dominant.coordinates.data()) * side < 0 ? -1.0 : 1.0;
    vector<double> penetration(space.n_pairs(), 0.0);
    gemv('N', along, space.gap, mode, 0.0, penetration.data());
    // what leaves the contact still is nothing that rounding could tell from what the system assumes
    const double omega_there = std::sqrt(found.modes.values[found.best]);
    const bool is_still = !(contact_motion(space, penetration, omega_there) > no_contact_motion);
    return found.likeness * (is_still ? 1.0 : contact.agreement(states, penetration));
}

} // namespace

double half_cycle_agreement(const Space &space, const DominantMode &dominant) {
    return std::min(agreement_of_half(space, dominant, 1), agreement_of_half(space, dominant, -1));
}

LinearSystem reference_system(LinearSystem asked, const Space &space, const RestState &rest, bool homogeneous,
                              ModeRequest request) {
    if (asked != LinearSystem::automatic) return asked;
    if (2 * rest.states.n_closed() > rest.states.size()) return LinearSystem::sliding;
    const bool holds = contact_holds_a_part(space);
    if (!homogeneous) return holds ? holding_system(space, rest) : LinearSystem::open;
    if (holds) return LinearSystem::sliding;
    double agreement[2];
    for (LinearSystem system : {LinearSystem::open, LinearSystem::sliding}) {
        request.system = system;
        const DominantMode dominant = find_dominant_mode(space, request, Watch());
        const bool is_driven = !proposes(request) || dominant.participation > 0;
        agreement[system == LinearSystem::sliding] = is_driven ? half_cycle_agreement(space, dominant) : 0;
    }
    return agreement[1] > clearly * agreement[0] ? LinearSystem::sliding : LinearSystem::open;
}

} // namespace plm
