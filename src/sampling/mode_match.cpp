#include "sampling/mode_match.hpp"
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

MatchedModes match_below(const Space &space, const PairStates &states, const vector<double> &shape,
                         double upper) {
    MatchedModes matched;
    matched.modes = modes_of_contact_set(space, states, upper);
    const std::int64_t count = matched.modes.vectors.cols();
    matched.mac.resize(count);
    for (std::int64_t j = 0; j < count; ++j) {
        matched.mac[j] = mac(space.n_massive(), matched.modes.vectors.col(j), shape.data());
        // Repeated and mirrored modes tie: do not let rounding choose.
        if (matched.best < 0 || matched.mac[j] > matched.mac[matched.best] + 1e-9) matched.best = j;
    }
    return matched;
}

bool is_settled(const MatchedModes &matched) {
    if (matched.best < 0) return false;
    double left = 1;
    for (double value : matched.mac) left -= value;
    return matched.mac[matched.best] >= left;
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
