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

namespace {

bool acts(const GapHarmonic &part) {
    const auto is_something = [](double g) { return g != 0; };
    return std::any_of(part.real.begin(), part.real.end(), is_something) ||
           std::any_of(part.imag.begin(), part.imag.end(), is_something);
}

} // namespace

int Contact::highest_motion() const {
    int highest = -1;
    for (const auto &[part, gaps] : motion)
        if (acts(gaps)) highest = std::max(highest, part.harmonic);
    return highest;
}

bool Contact::moves_by_frequency() const {
    return std::any_of(motion.begin(), motion.end(),
                       [](const auto &entry) { return entry.first.power != 0 && acts(entry.second); });
}

std::complex<double> Contact::moved(const GapHarmonic &harmonic, std::int64_t pair) {
    const auto at = static_cast<std::size_t>(pair);
    return {at < harmonic.real.size() ? harmonic.real[at] : 0.0,
            at < harmonic.imag.size() ? harmonic.imag[at] : 0.0};
}

Matrix Contact::motion_by(double (LoadPart::*growth)(double) const, std::int64_t n_harmonics, double omega,
                          std::int64_t multiple) const {
    Matrix g(n_pairs(), 2 * n_harmonics + 1);
    for (const auto &[part, gaps] : motion) {
        const std::int64_t h = part.harmonic * multiple;
        const double size = (part.*growth)(omega);
        for (std::int64_t i = 0; i < n_pairs() && h <= n_harmonics; ++i) {
            const std::complex<double> moves =
                size * moved(gaps, i); // Re(z exp(i h t)) = Re z cos - Im z sin
            g(i, h == 0 ? 0 : 2 * h - 1) += moves.real();
            if (h > 0) g(i, 2 * h) -= moves.imag();
        }
    }
    return g;
}

Matrix Contact::gaps(std::int64_t n_harmonics, double omega, double scale, std::int64_t multiple) const {
    Matrix g = gap_motion(n_harmonics, omega, multiple);
    for (std::int64_t k = 0; k < g.rows() * g.cols(); ++k) g.data()[k] *= scale;
    for (std::int64_t i = 0; i < n_pairs(); ++i) g(i, 0) += initial_gap[i];
    return g;
}

vector<double> Contact::gaps_at(double omega, double time, double scale) const {
    vector<double> g = initial_gap;
    for (const auto &[part, gaps] : motion) {
        const std::complex<double> turn =
            scale * part.growth(omega) * std::polar(1.0, part.harmonic * omega * time);
        for (std::int64_t i = 0; i < n_pairs(); ++i) g[i] += (moved(gaps, i) * turn).real();
    }
    return g;
}

vector<double> Contact::gap_rates_at(double omega, double time, double scale) const {
    vector<double> rate(initial_gap.size(), 0.0);
    for (const auto &[part, gaps] : motion) {
        const std::complex<double> turn = scale * part.growth(omega) *
                                          std::polar(1.0, part.harmonic * omega * time) *
                                          std::complex<double>(0, part.harmonic * omega);
        for (std::int64_t i = 0; i < n_pairs(); ++i) rate[i] += (moved(gaps, i) * turn).real();
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
    for (const auto &[part, gaps] : motion)
        for (std::int64_t i : pairs) {
            some.motion[part].real.push_back(moved(gaps, i).real());
            some.motion[part].imag.push_back(moved(gaps, i).imag());
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
