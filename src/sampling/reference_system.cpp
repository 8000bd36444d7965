#include "sampling/reference_system.hpp"
#include "sampling/contact_sweep.hpp"
#include "sampling/mode_match.hpp"
#include <algorithm>
#include <cmath>

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

// Share of the closed pairs' motion that presses, and of the open pairs' that parts; the lesser of the two.
double as_assumed(const vector<char> &closed, const vector<double> &stiffness,
                  const vector<double> &penetration) {
    double right[2] = {0, 0}, all[2] = {0, 0};
    for (std::size_t i = 0; i < closed.size(); ++i) {
        const bool c = closed[i] != 0;
        const double amount = std::abs(penetration[i]) * (c ? stiffness[i] : 1.0);
        all[c] += amount;
        if (c == (penetration[i] > 0)) right[c] += amount;
    }
    double least = 1;
    for (int c : {0, 1})
        if (all[c] > 0) least = std::min(least, right[c] / all[c]);
    return least;
}

double agreement_of_half(const Space &space, const DominantMode &dominant, double side) {
    vector<char> closed(dominant.mode_penetration.size());
    for (std::size_t i = 0; i < closed.size(); ++i) closed[i] = side * dominant.mode_penetration[i] > 0;
    const double omega = 2 * M_PI * dominant.frequency_hz;
    const MatchedModes found = match_modes(space, closed, dominant.coordinates, 9 * omega * omega);
    if (found.best < 0) return 0;
    const double *mode = found.modes.vectors.col(found.best);
    const double along = dot(space.size(), mode, dominant.coordinates.data()) * side < 0 ? -1.0 : 1.0;
    vector<double> penetration(space.n_pairs(), 0.0);
    gemv('N', along, space.gap, mode, 0.0, penetration.data());
    return found.mac[found.best] * as_assumed(closed, space.model->contact_stiffness(), penetration);
}

} // namespace

double half_cycle_agreement(const Space &space, const DominantMode &dominant) {
    return std::min(agreement_of_half(space, dominant, 1), agreement_of_half(space, dominant, -1));
}

LinearSystem reference_system(LinearSystem asked, const Space &space, const RestState &rest, bool homogeneous,
                              ModeRequest request) {
    if (asked != LinearSystem::automatic) return asked;
    const auto n_closed =
        std::count_if(rest.closed.begin(), rest.closed.end(), [](char c) { return c != 0; });
    if (2 * n_closed > static_cast<std::int64_t>(rest.closed.size())) return LinearSystem::sliding;
    if (!homogeneous) return LinearSystem::open;
    if (contact_holds_a_part(space)) return LinearSystem::sliding;
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
