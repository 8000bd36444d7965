#include "sampling/dominant_mode.hpp"
#include "sampling/contact_motion.hpp"
#include "sampling/mode_clusters.hpp"
#include "sampling/mode_match.hpp"
#include "space/rest.hpp"
#include "structure/driven_harmonic.hpp"
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

namespace plm {

PairStates contact_set(LinearSystem system, const Space &space) {
    if (system == LinearSystem::rest) return rest_of(space)->states;
    return system == LinearSystem::sliding ? PairStates::all_closed(space.n_pairs())
                                           : PairStates::all_open(space.n_pairs());
}

const char *name_of(LinearSystem system) {
    return system == LinearSystem::rest ? "rest" : system == LinearSystem::sliding ? "sliding" : "open";
}

bool is_homogeneous(const Model &model) {
    const auto zero = [](double v) { return v == 0; };
    return !model.has_preload() && std::all_of(model.initial_gap().begin(), model.initial_gap().end(), zero);
}

namespace {

constexpr std::int64_t n_proposed = 20; // modes a proposal looks at when no range is given
// Modal forces, of the largest: what rounding leaves of one that is none.
constexpr double not_driven = 1e-9;
// A structure on soft supports moves far below its first elastic mode, and its contact by inertia alone: a
// frequency over the next one, with nothing between, and a contact share over the largest.
constexpr double soft = 0.125, passes_by = 0.1;
// Resonances, estimated at equal damping, that one cannot tell apart by their size; and those that are equal
// but for rounding.
constexpr double alike = 0.95, same = 1 - 1e-6;
constexpr double together = 0.05; // of the frequency: the window about one resonance holds the other

// At least `count` modes and one above `hz`, or all there are.
SpaceModes lowest_modes(const Space &space, LinearSystem system, std::int64_t count, double hz) {
    const PairStates states = contact_set(system, space);
    const double reach = 2 * std::max(space.highest_frequency, 2 * M_PI * hz);
    if (reach > 0) {
        SpaceModes modes = modes_of_contact_set(space, states, reach * reach);
        if (modes.vectors.cols() >= count && !modes.values.empty() && to_hz(modes.values.back()) > hz)
            return modes;
    }
    return modes_of_contact_set(space, states, std::numeric_limits<double>::infinity());
}

// The lowest modes, and what a choice looks at.
struct Candidates {
    SpaceModes modes;
    vector<std::complex<double>> force; // phi . F
    vector<double> response;            // |phi . F| / omega^2: of a resonance at equal Q; 0 of rigid modes
    vector<double> contact_share;       // 0 of rigid modes, and where there is no more than rounding
    bool excited = false;               // there is an excitation at all
};

Candidates candidates(const Space &space, const vector<double> &spring, SpaceModes modes) {
    const DrivingLoads loads = driving_loads(space);
    align_clusters({&loads.rows, &space.gap}, modes);
    Candidates c{std::move(modes), {}, {}, {}};
    c.excited = !loads.parts.empty();
    const Matrix force = product('N', 'N', loads.rows, c.modes.vectors),
                 gap = product('N', 'N', space.gap, c.modes.vectors);
    for (std::int64_t j = 0; j < c.modes.vectors.cols(); ++j) {
        const double lambda = c.modes.values[j];
        c.force.emplace_back(0.0, 0.0);
        for (std::size_t p = 0; p < loads.parts.size(); ++p) { // as they are at its resonance
            const std::int64_t row = 2 * static_cast<std::int64_t>(p);
            const LoadPart &part = loads.parts[p];
            if (lambda > 0 || part.power == 0)
                c.force.back() += part.growth(std::sqrt(std::max(0.0, lambda)) / part.harmonic) *
                                  std::complex<double>(force(row, j), force(row + 1, j));
        }
        c.response.push_back(lambda > 0 ? std::abs(c.force.back()) / lambda : 0);
        const vector<double> dv(gap.col(j), gap.col(j + 1));
        const double omega = std::sqrt(std::max(0.0, lambda));
        const bool moves = lambda > 0 && contact_motion(space, dv, omega) > no_contact_motion;
        c.contact_share.push_back(moves ? contact_share(space, dv, omega, spring) : 0);
    }
    return c;
}

// The sign of a mode is an eigensolver's whim, and the samples of a sweep are taken from one end to the
// other: it moves along the load, or, where that does not move it, first closes the pair on which it acts
// most.
bool points_backwards(const std::complex<double> &force, const DominantMode &mode) {
    const double along = std::abs(force.imag()) > std::abs(force.real()) ? force.imag() : force.real();
    if (along != 0) return along < 0;
    constexpr double as_much = 1 - 1e-9; // pairs that mirror each other: the first one
    double most = 0;
    for (double v : mode.mode_penetration) most = std::max(most, std::abs(v));
    const auto first = std::find_if(mode.mode_penetration.begin(), mode.mode_penetration.end(),
                                    [&](double v) { return std::abs(v) >= as_much * most; });
    return first != mode.mode_penetration.end() && *first < 0;
}

// Flexible modes in the range searched, or the lowest ones.
vector<std::int64_t> searched(const SpaceModes &modes, const ModeRequest &request) {
    vector<std::int64_t> found;
    for (std::size_t j = 0; j < modes.values.size(); ++j) {
        const double hz = to_hz(modes.values[j]);
        if (hz <= 0) continue;
        if (request.search_max_hz > 0 && (hz < request.search_min_hz || hz > request.search_max_hz)) continue;
        if (request.search_max_hz <= 0 && static_cast<std::int64_t>(found.size()) == n_proposed) break;
        found.push_back(static_cast<std::int64_t>(j));
    }
    return found;
}

std::int64_t by_number(const SpaceModes &modes, const ModeRequest &request) {
    const std::int64_t count = modes.vectors.cols();
    if (request.mode > count)
        throw Error(status::argument, format("mode %lld of the %s system is asked for, but it has only %lld",
                                             static_cast<long long>(request.mode), name_of(request.system),
                                             static_cast<long long>(count)))
            .argument("mode")
            .index(request.mode);
    return request.mode - 1;
}

std::int64_t nearest_mode(const SpaceModes &modes, double hz) {
    std::int64_t best = 0;
    for (std::int64_t j = cluster_end(modes.values, 0); j < modes.vectors.cols();
         j = cluster_end(modes.values, j))
        if (std::abs(to_hz(modes.values[j]) - hz) < std::abs(to_hz(modes.values[best]) - hz)) best = j;
    return best;
}

// A frequency beside all modes that is that of one in rad/s.
void check_request(const SpaceModes &modes, double hz, double taken_hz, Watch watch) {
    constexpr double beside = 0.05, on_it = 0.01; // of the frequency
    const double as_rad_s = hz / (2 * M_PI), other_hz = to_hz(modes.values[nearest_mode(modes, as_rad_s)]);
    if (std::abs(taken_hz / hz - 1) < beside || std::abs(other_hz / as_rad_s - 1) > on_it) return;
    watch.warn(reason::outside_basis,
               format("the mode nearest mode_frequency_hz = %.6g is one at %.6g Hz, but in rad/s that "
                      "frequency would be the mode at %.6g Hz. Divide it by 2 pi if that was meant, or name "
                      "the mode by its number (mode)",
                      hz, taken_hz, other_hz));
}

std::int64_t by_frequency(const SpaceModes &modes, double hz, Watch watch) {
    const std::int64_t best = nearest_mode(modes, hz);
    check_request(modes, hz, to_hz(modes.values[best]), watch);
    return best;
}

// Those of some that come up to this share of the largest.
vector<std::int64_t> largest(const vector<double> &size, const vector<std::int64_t> &of, double share) {
    double most = 0;
    for (std::int64_t j : of) most = std::max(most, size[j]);
    vector<std::int64_t> found;
    for (std::int64_t j : of)
        if (size[j] > 0 && size[j] >= share * most) found.push_back(j);
    return found;
}

vector<std::int64_t> on_contact(const Candidates &c, const vector<std::int64_t> &among) {
    double most = 0;
    for (std::int64_t j : among) most = std::max(most, c.contact_share[j]);
    std::size_t elastic = 0; // the first that is not on soft supports
    for (std::size_t p = 1; p < among.size(); ++p)
        if (c.modes.values[among[p - 1]] < soft * soft * c.modes.values[among[p]]) elastic = p;
    vector<std::int64_t> found;
    for (std::size_t p = 0; p < among.size(); ++p) {
        const double share = c.contact_share[among[p]];
        if (share > 0 && (p >= elastic || share >= passes_by * most)) found.push_back(among[p]);
    }
    return found;
}

// Those that move the contact; of the others only where there are none of these.
vector<std::int64_t> moving(const Candidates &c, const vector<std::int64_t> &among,
                            const vector<std::int64_t> &wanted) {
    vector<std::int64_t> found;
    for (std::int64_t j : on_contact(c, among))
        if (std::count(wanted.begin(), wanted.end(), j) > 0) found.push_back(j);
    return found.empty() ? wanted : found;
}

void tell_of_ties(const Candidates &c, const vector<std::int64_t> &eligible, std::int64_t taken,
                  Watch watch) {
    const double taken_hz = to_hz(c.modes.values[taken]);
    for (std::int64_t j : largest(c.response, eligible, alike)) {
        const double hz = to_hz(c.modes.values[j]);
        if (std::abs(hz / taken_hz - 1) < together) continue;
        watch.warn(reason::tie,
                   format("the excitation drives two modes alike, at %.6g Hz and at %.6g Hz (by responses "
                          "estimated as 1 to %.3g): that at %.6g Hz is taken as the dominant mode, but the "
                          "resonance of the other may be higher. Look at that, too: mode_frequency_hz = %.6g "
                          "of a sampler",
                          taken_hz, hz, c.response[j] / c.response[taken], taken_hz, hz));
    }
}

std::int64_t by_response(const Candidates &c, const vector<std::int64_t> &among, const ModeRequest &request,
                         Watch watch) {
    if (among.empty())
        throw Error(
            status::argument,
            format("the %s system has no flexible mode%s; widen the search (\"search_max_hz\"), name "
                   "the mode (\"mode\"), or take another \"system\"",
                   name_of(request.system),
                   request.search_max_hz > 0
                       ? format(" in [%g, %g] Hz", request.search_min_hz, request.search_max_hz).c_str()
                       : ""))
            .argument(request.search_max_hz > 0 ? "search_max_hz" : "mode");
    vector<double> force;
    for (const std::complex<double> &f : c.force) force.push_back(std::abs(f));
    const vector<std::int64_t> driven = largest(force, among, not_driven),
                               eligible = moving(c, among, driven);
    if (!eligible.empty()) { // of equal ones the lowest: rounding is not to choose
        const std::int64_t best = largest(c.response, eligible, same).front();
        tell_of_ties(c, eligible, best, watch);
        return best;
    }
    watch.warn(
        reason::lost_mode,
        c.excited
            ? "the excitation moves no mode searched: the lowest flexible one is taken as the dominant mode; "
              "name the mode if another is meant"
            : "no harmonic excitation acts on the free DOFs: the forced response is zero, and the lowest "
              "flexible mode is taken as the dominant one. Give the model an excitation of harmonic 1 or "
              "above, on DOFs that are not fixed");
    return moving(c, among, among).front();
}

std::int64_t choose(const Candidates &c, const vector<std::int64_t> &among, const ModeRequest &request,
                    Watch watch) {
    if (request.mode > 0) return by_number(c.modes, request);
    if (request.frequency_hz > 0 && c.modes.vectors.cols() > 0)
        return by_frequency(c.modes, request.frequency_hz, watch);
    return by_response(c, among, request, watch);
}

// Of the squares of the responses.
double participation_of(const vector<double> &response, vector<std::int64_t> among, std::int64_t chosen) {
    if (std::find(among.begin(), among.end(), chosen) == among.end()) among.push_back(chosen);
    double size = 0;
    for (std::int64_t j : among) size = std::hypot(size, response[j]);
    return size > 0 ? std::pow(response[chosen] / size, 2) : 0;
}

} // namespace

DominantMode find_dominant_mode(const Space &space, const ModeRequest &request, Watch watch) {
    std::int64_t rigid = 0; // not proposed, but counted
    while (rigid < space.n_massive() && space.lambda[rigid] == 0) ++rigid;
    const Candidates c =
        candidates(space, space.model->contact().springs(contact_set(request.system, space)),
                   lowest_modes(space, request.system, std::max(request.mode, rigid + n_proposed),
                                std::max(request.frequency_hz, request.search_max_hz)));
    const vector<std::int64_t> among = searched(c.modes, request);
    const std::int64_t chosen = choose(c, among, request, watch);

    DominantMode dominant;
    dominant.system = request.system;
    dominant.mode = chosen + 1;
    dominant.frequency_hz = to_hz(c.modes.values[chosen]);
    dominant.harmonic = std::max(1, driven_harmonic(drive_of(space)));
    dominant.participation = participation_of(c.response, among, chosen);
    dominant.coordinates.assign(c.modes.vectors.col(chosen), c.modes.vectors.col(chosen) + space.size());
    dominant.mode_penetration.assign(space.n_pairs(), 0.0);
    gemv('N', 1.0, space.gap, dominant.coordinates.data(), 0.0, dominant.mode_penetration.data());
    if (points_backwards(c.force[chosen], dominant))
        for (vector<double> *values : {&dominant.coordinates, &dominant.mode_penetration})
            for (double &v : *values) v = -v;
    return dominant;
}

} // namespace plm
