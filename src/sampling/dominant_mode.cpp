#include "sampling/dominant_mode.hpp"
#include "sampling/mode_match.hpp"
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

namespace plm {

PairStates contact_set(LinearSystem system, std::int64_t n_pairs) {
    return system == LinearSystem::sliding ? PairStates::all_closed(n_pairs) : PairStates::all_open(n_pairs);
}

bool is_homogeneous(const Model &model) {
    const auto zero = [](double v) { return v == 0; };
    return !model.has_preload() && std::all_of(model.initial_gap().begin(), model.initial_gap().end(), zero);
}

namespace {

constexpr std::int64_t n_proposed = 20; // modes a proposal looks at when no range is given

const char *name_of(LinearSystem system) {
    return system == LinearSystem::sliding ? "sliding" : "open";
}

// At least `count` modes and one above `hz`, or all there are.
SpaceModes lowest_modes(const Space &space, LinearSystem system, std::int64_t count, double hz) {
    const PairStates states = contact_set(system, space.n_pairs());
    const double reach = 2 * std::max(space.highest_frequency, 2 * M_PI * hz);
    if (reach > 0) {
        SpaceModes modes = modes_of_contact_set(space, states, reach * reach);
        if (modes.vectors.cols() >= count && !modes.values.empty() && to_hz(modes.values.back()) > hz)
            return modes;
    }
    return modes_of_contact_set(space, states, std::numeric_limits<double>::infinity());
}

// phi . F, F the first harmonic of the excitation (or its lowest one).
std::complex<double> modal_force(const Space &space, const double *phi) {
    const auto load = space.excitation.upper_bound(0);
    if (load == space.excitation.end()) return 0;
    const auto modal = [&](const vector<double> &f) {
        return f.empty() ? 0.0 : dot(space.size(), phi, f.data());
    };
    return {modal(load->second.real), modal(load->second.imag)};
}

// |phi . F|^2 / omega^4: the squared resonance amplitude of each mode at equal Q, up to a common factor; 0
// for rigid-body modes.
vector<double> responses(const Space &space, const SpaceModes &modes) {
    vector<double> response(modes.values.size(), 0.0);
    for (std::size_t j = 0; j < response.size(); ++j)
        if (modes.values[j] > 0)
            response[j] = std::norm(modal_force(space, modes.vectors.col(static_cast<std::int64_t>(j))) /
                                    modes.values[j]);
    return response;
}

// The sign of a mode is an eigensolver's whim, and the samples of a sweep are taken from one end to the
// other: it moves along the load, or, where that does not move it, first closes the pair on which it acts
// most.
bool points_backwards(const Space &space, const DominantMode &mode) {
    const std::complex<double> force = modal_force(space, mode.coordinates.data());
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
vector<std::int64_t> candidates(const SpaceModes &modes, const ModeRequest &request) {
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
        throw Error(PLM_ERR_ARGUMENT, format("mode %lld of the %s system is asked for, but it has only %lld",
                                             static_cast<long long>(request.mode), name_of(request.system),
                                             static_cast<long long>(count)))
            .argument("mode")
            .index(request.mode);
    return request.mode - 1;
}

std::int64_t nearest_mode(const SpaceModes &modes, double hz) {
    std::int64_t best = 0;
    for (std::int64_t j = 1; j < modes.vectors.cols(); ++j)
        if (std::abs(to_hz(modes.values[j]) - hz) < std::abs(to_hz(modes.values[best]) - hz)) best = j;
    return best;
}

// A frequency beside all modes that is that of one in rad/s.
void check_request(const SpaceModes &modes, double hz, double taken_hz, Watch watch) {
    constexpr double beside = 0.05, on_it = 0.01; // of the frequency
    const double as_rad_s = hz / (2 * M_PI), other_hz = to_hz(modes.values[nearest_mode(modes, as_rad_s)]);
    if (std::abs(taken_hz / hz - 1) < beside || std::abs(other_hz / as_rad_s - 1) > on_it) return;
    watch.warn(PLM_REASON_OUTSIDE_BASIS,
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

std::int64_t by_response(const vector<double> &response, const vector<std::int64_t> &among,
                         const ModeRequest &request, Watch watch) {
    if (among.empty())
        throw Error(PLM_ERR_ARGUMENT,
                    format("the %s system has no flexible mode in [%g, %g] Hz; widen the search or "
                           "name the mode",
                           name_of(request.system), request.search_min_hz, request.search_max_hz))
            .argument(request.search_max_hz > 0 ? "search_max_hz" : "mode");
    const auto weaker = [&](std::int64_t i, std::int64_t j) { return response[i] < response[j]; };
    const std::int64_t best = *std::max_element(among.begin(), among.end(), weaker);
    if (response[best] > 0) return best;
    watch.warn(
        PLM_REASON_LOST_MODE,
        "the excitation moves no mode searched: the lowest flexible one is taken as the dominant mode; name "
        "the mode if another is meant");
    return among.front();
}

std::int64_t choose(const SpaceModes &modes, const vector<double> &response,
                    const vector<std::int64_t> &among, const ModeRequest &request, Watch watch) {
    if (request.mode > 0) return by_number(modes, request);
    if (request.frequency_hz > 0 && modes.vectors.cols() > 0)
        return by_frequency(modes, request.frequency_hz, watch);
    return by_response(response, among, request, watch);
}

double participation_of(const vector<double> &response, vector<std::int64_t> among, std::int64_t chosen) {
    if (std::find(among.begin(), among.end(), chosen) == among.end()) among.push_back(chosen);
    double sum = 0;
    for (std::int64_t j : among) sum += response[j];
    return sum > 0 ? response[chosen] / sum : 0;
}

} // namespace

DominantMode find_dominant_mode(const Space &space, const ModeRequest &request, Watch watch) {
    std::int64_t rigid = 0; // not proposed, but counted
    while (rigid < space.n_massive() && space.lambda[rigid] == 0) ++rigid;
    const SpaceModes modes = lowest_modes(space, request.system, std::max(request.mode, rigid + n_proposed),
                                          std::max(request.frequency_hz, request.search_max_hz));
    const vector<double> response = responses(space, modes);
    const vector<std::int64_t> among = candidates(modes, request);
    const std::int64_t chosen = choose(modes, response, among, request, watch);

    DominantMode dominant;
    dominant.system = request.system;
    dominant.mode = chosen + 1;
    dominant.frequency_hz = to_hz(modes.values[chosen]);
    dominant.participation = participation_of(response, among, chosen);
    dominant.coordinates.assign(modes.vectors.col(chosen), modes.vectors.col(chosen) + space.size());
    dominant.mode_penetration.assign(space.n_pairs(), 0.0);
    gemv('N', 1.0, space.gap, dominant.coordinates.data(), 0.0, dominant.mode_penetration.data());
    if (points_backwards(space, dominant))
        for (vector<double> *values : {&dominant.coordinates, &dominant.mode_penetration})
            for (double &v : *values) v = -v;
    return dominant;
}

} // namespace plm
