#include "contact/piece_events.hpp"
#include "contact/polynomial.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm {
namespace {

constexpr double of_rounding = 16;
constexpr double gap_noise = of_rounding * std::numeric_limits<double>::epsilon();
constexpr double clear_of_noise = 1e4;

} // namespace

PieceEvents::PieceEvents(const Contact &contact, const Matrix &gap, double omega, double wall_scale)
    : states_(PairStates::all_closed(gap.rows())), at_zero_(gap.rows()), row_norm_(gap.rows()),
      gap_size_(gap.rows()), noise_(gap.rows()), polynomial_(max_polynomial_degree + 1), sides_(gap.rows()) {
    for (std::int64_t i = 0; i < gap.rows(); ++i) {
        double sum = 0;
        for (std::int64_t j = 0; j < gap.cols(); ++j) sum += gap(i, j) * gap(i, j);
        row_norm_[i] = std::sqrt(sum);
        gap_size_[i] = std::abs(contact.initial_gap[i]);
        for (const auto &[part, gaps] : contact.motion)
            gap_size_[i] += std::abs(wall_scale * part.growth(omega) * Contact::moved(gaps, i));
    }
}

void PieceEvents::guess(const vector<double> &penetration) {
    forget_zeros();
    states_ = states_at(penetration);
}

void PieceEvents::forget_zeros() {
    std::fill(at_zero_.begin(), at_zero_.end(), char(0));
}

bool PieceEvents::correct(const PiecePenetrations &penetrations, double reach) {
    for (std::int64_t i = 0; i < states_.size(); ++i)
        noise_[i] = gap_noise * (gap_size_[i] + row_norm_[i] * reach);
    return confirm(penetrations);
}

bool PieceEvents::correct(const PiecePenetrations &penetrations, const vector<double> &rounding) {
    for (std::int64_t i = 0; i < states_.size(); ++i) noise_[i] = of_rounding * rounding[i];
    return confirm(penetrations);
}

bool PieceEvents::confirm(const PiecePenetrations &penetrations) {
    const vector<double> &begin = penetrations.at_begin();
    for (std::int64_t i = 0; i < states_.size(); ++i) sides_[i] = side_of(&begin[i], 1, i);
    const Matrix &powers = penetrations.powers();
    for (std::int64_t c = 0; c < powers.cols(); ++c) {
        const std::int64_t i = penetrations.near()[c];
        sides_[i] = side_of(powers.col(c), powers.rows(), i);
    }
    bool changed = false;
    for (std::int64_t i = 0; i < states_.size(); ++i) {
        if (sides_[i].power < 0 || sides_[i].closed == states_.is_closed(i)) continue;
        states_.set(i, sides_[i].closed);
        changed = true;
    }
    return changed;
}

bool PieceEvents::leave_clearly() const {
    for (std::size_t i = 0; i < at_zero_.size(); ++i)
        if (at_zero_[i] && !(sides_[i].power == 1 && sides_[i].size > clear_of_noise * noise_[i]))
            return false;
    return true;
}

PieceEvents::Side PieceEvents::side_of(const double *p, std::int64_t n_terms, std::int64_t pair) const {
    for (std::int64_t k = at_zero_[pair] ? 1 : 0; k < n_terms; ++k)
        if (std::abs(p[k]) > noise_[pair]) return {k, std::abs(p[k]), ContactLaw::closed(p[k])};
    return {-1, 0, states_.is_closed(pair)}; // rests at zero: either side is right
}

double PieceEvents::first(const PiecePenetrations &penetrations, std::int64_t &pair, double together) {
    const Matrix &powers = penetrations.powers();
    double share = 1; // the rest of the piece is of no interest once an event is known
    pair = -1;
    leaving_.clear();
    for (std::int64_t c = 0; c < powers.cols(); ++c) {
        const std::int64_t i = penetrations.near()[c];
        const double at = crossing(powers.col(c), powers.rows(), i, std::min(share + together, 1.0));
        if (at < 0) continue;
        leaving_.push_back({at, i});
        if (pair >= 0 && at >= share) continue;
        share = at;
        pair = i;
    }
    const double first = share;
    const auto later = [&](const Event &event) { return event.share > first + together; };
    leaving_.erase(std::remove_if(leaving_.begin(), leaving_.end(), later), leaving_.end());
    for (const Event &event : leaving_) share = std::max(share, event.share);
    return share;
}

// The cubic through values and rates at both ends is off by s^2 (1 - s)^2 duration^4 / 24 of the fourth
// derivative at most. Its Bernstein coefficients less that one's, as polynomials of degree four, are all on
// the pair's side where the pair is. A zero at an end is known and divided out by its coefficient being zero.
std::int64_t PieceEvents::not_staying(const Matrix &begin, const Matrix &end, const vector<double> &fourth,
                                      const vector<double> &rounding, double duration, std::int64_t leaving) {
    const double fourth_power = duration * duration * duration * duration;
    std::int64_t worst = -1;
    double beyond = 0;
    for (std::int64_t i = 0; i < states_.size(); ++i) {
        const double side = states_.is_closed(i) ? 1 : -1, noise = of_rounding * rounding[i],
                     u0 = at_zero_[i] ? 0 : side * begin(i, 0), u1 = i == leaving ? 0 : side * end(i, 0),
                     b1 = u0 + side * begin(i, 1) * duration / 3, b2 = u1 - side * end(i, 1) * duration / 3,
                     off = fourth[i] * fourth_power / (24 * 6);
        const bool stays = (u0 > noise || at_zero_[i]) && (u1 > noise || i == leaving) &&
                           u0 + 3 * b1 > (at_zero_[i] ? clear_of_noise : 1) * noise &&
                           3 * b2 + u1 > (i == leaving ? clear_of_noise : 1) * noise &&
                           0.5 * (b1 + b2) > off + noise;
        if (stays || (worst >= 0 && u1 >= beyond)) continue;
        worst = i;
        beyond = u1;
    }
    leaving_.clear();
    if (worst < 0 && leaving >= 0) leaving_.push_back({1.0, leaving});
    return worst;
}

// Share of the piece, or -1.
double PieceEvents::crossing(const double *p, std::int64_t n_terms, std::int64_t pair, double until) {
    const std::int64_t power = sides_[pair].power;
    if (power < 0) return -1;
    const double sign = states_.is_closed(pair) ? 1.0 : -1.0, first = sign * p[power];
    if (!(first > 0)) return -1; // no side was found that the motion confirms
    double reach = 0;
    for (std::int64_t k = power + 1; k < n_terms; ++k) reach += std::abs(p[k]);
    if (first >= reach) return -1;
    worked(10.0 * static_cast<double>(n_terms * n_terms));
    double scale = sign;
    for (std::int64_t k = power; k < n_terms; ++k, scale *= until) polynomial_[k - power] = scale * p[k];
    const double at = first_crossing(polynomial_.data(), n_terms - 1 - power, noise_[pair]);
    return at < 0 ? -1 : until * at;
}

std::int64_t PieceEvents::pass() {
    for (const Event &event : leaving_) {
        states_.switch_pair(event.pair);
        at_zero_[event.pair] = 1;
    }
    return static_cast<std::int64_t>(leaving_.size());
}

} // namespace plm
