#include "contact/contact.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

static_assert(Contact::n_directions == 1, "what stands below has one number for each pair, along its normal");

vector<double> Contact::unloaded_penetration() const {
    vector<double> u(initial_gap.size());
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = -initial_gap[i];
    return u;
}

bool Contact::has_interference() const {
    return std::any_of(initial_gap.begin(), initial_gap.end(), [](double g) { return g < 0; });
}

int Contact::highest_motion() const {
    const auto acts = [](double g) { return g != 0; };
    int highest = -1;
    for (const auto &[harmonic, part] : motion)
        if (std::any_of(part.real.begin(), part.real.end(), acts) ||
            std::any_of(part.imag.begin(), part.imag.end(), acts))
            highest = std::max(highest, harmonic);
    return highest;
}

std::complex<double> Contact::moved(const GapHarmonic &harmonic, std::int64_t pair) {
    const auto at = static_cast<std::size_t>(pair);
    return {at < harmonic.real.size() ? harmonic.real[at] : 0.0,
            at < harmonic.imag.size() ? harmonic.imag[at] : 0.0};
}

Matrix Contact::gap_motion(std::int64_t n_harmonics, std::int64_t multiple) const {
    Matrix g(n_pairs(), 2 * n_harmonics + 1);
    for (const auto &[harmonic, part] : motion) {
        const std::int64_t h = harmonic * multiple;
        for (std::int64_t i = 0; i < n_pairs() && h <= n_harmonics; ++i) {
            const std::complex<double> moves = moved(part, i); // Re(z exp(i h t)) = Re z cos - Im z sin
            g(i, h == 0 ? 0 : 2 * h - 1) = moves.real();
            if (h > 0) g(i, 2 * h) = -moves.imag();
        }
    }
    return g;
}

Matrix Contact::gaps(std::int64_t n_harmonics, double scale, std::int64_t multiple) const {
    Matrix g = gap_motion(n_harmonics, multiple);
    for (std::int64_t k = 0; k < g.rows() * g.cols(); ++k) g.data()[k] *= scale;
    for (std::int64_t i = 0; i < n_pairs(); ++i) g(i, 0) += initial_gap[i];
    return g;
}

vector<double> Contact::gaps_at(double angle, double scale) const {
    vector<double> g = initial_gap;
    for (const auto &[harmonic, part] : motion) {
        const std::complex<double> turn = scale * std::polar(1.0, harmonic * angle);
        for (std::int64_t i = 0; i < n_pairs(); ++i) g[i] += (moved(part, i) * turn).real();
    }
    return g;
}

vector<double> Contact::gap_rates_at(double angle, double scale) const {
    vector<double> rate(initial_gap.size(), 0.0);
    for (const auto &[harmonic, part] : motion) {
        const std::complex<double> turn =
            scale * std::polar(1.0, harmonic * angle) * std::complex<double>(0, harmonic);
        for (std::int64_t i = 0; i < n_pairs(); ++i) rate[i] += (moved(part, i) * turn).real();
    }
    return rate;
}

vector<double> Contact::wall_springs(const vector<double> &rest) const {
    vector<double> spring = closed_shares(rest);
    const bool apart = std::all_of(spring.begin(), spring.end(), [](double share) { return share == 0; });
    for (std::size_t i = 0; i < spring.size(); ++i) spring[i] = (apart ? 1 : spring[i]) * stiffness[i];
    return spring;
}

Contact Contact::of_pairs(const vector<std::int64_t> &pairs, vector<double> of_them) const {
    Contact some;
    some.stiffness = std::move(of_them);
    for (std::int64_t i : pairs) some.initial_gap.push_back(initial_gap[i]);
    for (const auto &[harmonic, part] : motion)
        for (std::int64_t i : pairs) {
            some.motion[harmonic].real.push_back(moved(part, i).real());
            some.motion[harmonic].imag.push_back(moved(part, i).imag());
        }
    return some;
}

vector<double> Contact::forces(const vector<double> &u) const {
    vector<double> n(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) n[i] = ContactLaw::force(stiffness[i], u[i]);
    return n;
}

vector<double> Contact::tangents(const vector<double> &u) const {
    vector<double> k(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) k[i] = ContactLaw::tangent(stiffness[i], u[i]);
    return k;
}

PairStates states_at(const vector<double> &u) {
    PairStates states = PairStates::all_open(static_cast<std::int64_t>(u.size()));
    for (std::int64_t i = 0; i < states.size(); ++i) states.set(i, ContactLaw::closed(u[i]));
    return states;
}

vector<double> Contact::springs(const PairStates &states) const {
    vector<double> spring(stiffness);
    for (std::int64_t i = 0; i < states.size(); ++i)
        if (!states.is_closed(i)) spring[i] = 0;
    return spring;
}

vector<double> Contact::closed_shares(const vector<double> &u) const {
    vector<double> share(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) share[i] = u[i] > 0 ? 1.0 : u[i] < 0 ? 0.0 : 0.5;
    return share;
}

double Contact::agreement(const PairStates &states, const vector<double> &u) const {
    double right[2] = {0, 0}, all[2] = {0, 0};
    for (std::int64_t i = 0; i < states.size(); ++i) {
        const bool closed = states.is_closed(i);
        const double amount = std::abs(u[i]) * (closed ? stiffness[i] : 1.0);
        all[closed] += amount;
        if (closed == ContactLaw::closed(u[i])) right[closed] += amount;
    }
    double least = 1;
    for (int c : {0, 1})
        if (all[c] > 0) least = std::min(least, right[c] / all[c]);
    return least;
}

} // namespace plm
