#include "sampling/mode_match.hpp"
#include "sampling/contact_motion.hpp"
#include "sampling/mode_clusters.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plm {

double mac(std::int64_t n, const double *x, const double *y) {
    const double size_x = norm2(n, x), size_y = norm2(n, y);
    if (!(size_x > 0) || !(size_y > 0)) return 0;
    double cosine = 0; // scaled first: no overflow
    for (std::int64_t i = 0; i < n; ++i) cosine += (x[i] / size_x) * (y[i] / size_y);
    return cosine * cosine;
}

double to_hz(double eigenvalue) {
    return std::sqrt(std::max(eigenvalue, 0.0)) / (2 * M_PI);
}

namespace {

// How nearly another mode has to resemble the shape: not less than one can tell them apart by.
constexpr double as_well = 0.9;
constexpr double hardly = 0.01; // no need to ask what such a mode does
// Of the best of all: what moves the contact is not all that far from a shape that does.
constexpr double far_from_best = 0.1;

// Rigid motion is not what passes by.
bool moves_contact(const Space &space, const SpaceModes &modes, std::int64_t j) {
    if (!(modes.values[j] > 0)) return true;
    vector<double> dv(static_cast<std::size_t>(space.n_pairs()));
    gemv('N', 1.0, space.gap, modes.vectors.col(j), 0.0, dv.data());
    return contact_motion(space, dv, std::sqrt(modes.values[j])) > no_contact_motion;
}

// Mirrored modes tie: rounding is not to choose.
bool exceeds(double mac, double best) {
    return mac > best + 1e-9;
}

void choose(const Space &space, MatchedModes &matched) {
    const vector<double> &mac = matched.mac;
    std::int64_t moving = -1, any = -1;
    double passing_by = 0; // the shape's part in modes that do
    for (std::size_t k = 0; k < mac.size(); ++k) {
        const std::int64_t j = static_cast<std::int64_t>(k);
        if (any < 0 || exceeds(mac[j], mac[any])) any = j;
        if (mac[j] > hardly && !moves_contact(space, matched.modes, j))
            passing_by += mac[j];
        else if (moving < 0 || exceeds(mac[j], mac[moving]))
            moving = j;
    }
    matched.moves = moving >= 0 && mac[moving] > far_from_best * mac[any];
    matched.best = matched.moves ? moving : any;
    if (any >= 0) matched.likeness = matched.moves ? mac[moving] / (1 - passing_by) : mac[any];
    for (std::size_t k = 0; k < mac.size(); ++k) {
        const std::int64_t j = static_cast<std::int64_t>(k);
        if (j != matched.best && mac[j] > as_well * mac[matched.best] &&
            (matched.rival < 0 || exceeds(mac[j], mac[matched.rival])))
            matched.rival = j;
    }
}

MatchedModes match_below(const Space &space, const PairStates &states, const vector<double> &shape,
                         double upper) {
    MatchedModes matched;
    matched.modes = modes_of_contact_set(space, states, upper);
    const Matrix row = row_of(space, shape);
    align_clusters({&row}, matched.modes);
    for (std::int64_t j = 0; j < matched.modes.vectors.cols(); ++j)
        matched.mac.push_back(mac(space.n_massive(), matched.modes.vectors.col(j), shape.data()));
    choose(space, matched);
    return matched;
}

bool is_settled(const MatchedModes &matched) {
    if (matched.best < 0) return false;
    double left = 1;
    for (double value : matched.mac) left -= value;
    const double enough = matched.moves ? as_well : far_from_best; // for a better one, or a rival
    return enough * matched.mac[matched.best] >= left;
}

} // namespace

MatchedModes match_modes(const Space &space, const PairStates &states, const vector<double> &shape,
                         double upper) {
    for (int attempt = 0; attempt < 3 && upper > 0; ++attempt, upper *= 9) {
        MatchedModes matched = match_below(space, states, shape, upper);
        if (is_settled(matched) || matched.modes.vectors.cols() == space.n_massive()) return matched;
    }
    return match_below(space, states, shape, std::numeric_limits<double>::infinity());
}

} // namespace plm
