#include "contact/contact_step.hpp"
#include "linalg/error.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm {
namespace {

constexpr std::int64_t most_iterations = 500;
constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

} // namespace

ContactStep::ContactStep(Matrix flexibility, const vector<double> &contact_stiffness)
    : flexibility_(std::move(flexibility)), stiffness_(contact_stiffness),
      states_(PairStates::all_open(static_cast<std::int64_t>(stiffness_.size()))), u_(stiffness_.size()),
      direction_(stiffness_.size()), change_(stiffness_.size()), small_(stiffness_.size()) {}

void ContactStep::solve(const vector<double> &u_free, vector<double> &force) {
    const std::size_t z = stiffness_.size();
    if (z == 0) return;
    double largest = 0;
    for (double u : u_free) largest = std::max(largest, std::abs(u));
    u_ = u_free;
    gemv('N', -1.0, flexibility_, force.data(), 1.0, u_.data());
    for (std::int64_t k = 0; k < most_iterations; ++k) {
        ++iterations_;
        for (std::size_t i = 0; i < z; ++i) states_.set(i, ContactLaw::closed(u_[i]));
        factor_closed();
        for (std::size_t a = 0; a < active_.size(); ++a) small_[a] = u_free[active_[a]];
        cholesky_.solve(small_.data(), 1, static_cast<std::int64_t>(active_.size()));
        for (std::size_t i = 0; i < z; ++i) direction_[i] = -force[i];
        for (std::size_t a = 0; a < active_.size(); ++a) direction_[active_[a]] += small_[a];
        gemv('N', -1.0, flexibility_, direction_.data(), 0.0, change_.data());
        const bool found = settled(rounding * largest); // the whole step solves the problem
        const double t = found ? 1.0 : line_search(force);
        for (std::size_t i = 0; i < z; ++i) {
            force[i] += t * direction_[i];
            u_[i] += t * change_[i];
        }
        if (found) return;
    }
    throw Error(status::convergence,
                "the contact forces of a time step were not found; the contact set changes "
                "back and forth: take smaller steps")
        .reason(reason::contact_chatter);
}

void ContactStep::factor_closed() {
    if (states_ == factored_) return;
    active_ = states_.closed_pairs();
    const std::int64_t n = static_cast<std::int64_t>(active_.size());
    matrix_.reset(n, n);
    for (std::int64_t j = 0; j < n; ++j) {
        for (std::int64_t i = 0; i < n; ++i) matrix_(i, j) = flexibility_(active_[i], active_[j]);
        matrix_(j, j) += 1 / stiffness_[active_[j]];
    }
    factored_ = states_;
    ++factorizations_;
    if (cholesky_.factor(matrix_)) return;
    factored_ = PairStates();
    throw Error(status::singular, "the contact flexibility of the time step is not positive definite")
        .reason(reason::singular);
}

// After the whole step the pairs it was computed for are those that are closed; a pair at zero may be either.
bool ContactStep::settled(double noise) const {
    for (std::size_t i = 0; i < u_.size(); ++i) {
        const double u = u_[i] + change_[i];
        if (ContactLaw::closed(u) != states_.is_closed(i) && std::abs(u) > noise) return false;
    }
    return true;
}

// Exact minimum of the energy along the direction: its slope is piecewise linear and increasing. 1 when the
// whole step does not go beyond the minimum.
double ContactStep::line_search(const vector<double> &force) const {
    const auto slope = [&](double t) {
        double s = 0;
        for (std::size_t i = 0; i < u_.size(); ++i)
            s -= change_[i] *
                 (force[i] + t * direction_[i] - ContactLaw::force(stiffness_[i], u_[i] + t * change_[i]));
        return s;
    };
    const double first = std::abs(slope(0.0)), full = slope(1.0);
    if (full <= 1e-10 * first) return 1;
    double low = 0, high = 1;
    for (int k = 0; k < 100 && high - low > 1e-14 * high; ++k) {
        const double middle = 0.5 * (low + high);
        (slope(middle) < 0 ? low : high) = middle;
    }
    return high;
}

} // namespace plm
