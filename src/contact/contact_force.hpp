// Contact force and its derivative in the frequency domain (AFT; paper, 2.2). With s(t) = [u(t) > 0] the
// indicator of a pair and J(s) the matrix of its Fourier averages, force coefficients = k_n J(s) u and
// derivative = k_n J(s): one set of 4H + 1 numbers per pair serves both, for the event-exact and for the
// sampled AFT.
#pragma once
#include "contact/contact_law.hpp"
#include "contact/pair_states.hpp"
#include "linalg/dft.hpp"
#include <memory>

namespace plm {

/// Averages over the period of s, s cos t, s sin t, ..., s cos 2Ht, s sin 2Ht: (4H + 1) x Z, and who
/// switches.
struct ContactIndicator {
    Matrix averages;
    vector<PairState> state;
    std::int64_t n_switching = 0;
    /// Of n_pairs pairs that are open throughout, in the harmonics of n_harmonics.
    void reset(std::int64_t n_harmonics, std::int64_t n_pairs);

    /// The pair presses at some time.
    bool acts(std::int64_t pair) const { return ContactLaw::acts(state[pair]); }
    /// Its tangent depends on time; where it does not: this share of its stiffness.
    bool varies(std::int64_t pair) const { return ContactLaw::varies(state[pair]); }
    double constant_share(std::int64_t pair) const { return ContactLaw::constant_share(state[pair]); }
    /// Mean over the period and the pairs of what is closed, 0 to 1; 0 without pairs.
    double closed_share() const;
};

class ContactForce {
  public:
    virtual ~ContactForce() = default;
    /// u: Z x (2H + 1) coefficients of the penetration, column c is coefficient c.
    virtual void indicator(const Matrix &u, ContactIndicator &out) = 0;
};

/// Switching instants are zeros of the trigonometric polynomial u: found, not sampled; averages in closed
/// form.
std::unique_ptr<ContactForce> make_event_force(std::int64_t n_harmonics, std::int64_t n_pairs);
/// The classical AFT on `time_samples` (>= 4H + 1) equidistant instants.
std::unique_ptr<ContactForce> make_sampled_force(std::int64_t n_harmonics, std::int64_t time_samples,
                                                 std::int64_t n_pairs);

/// Averages for a constant indicator: coupling[i] in [0, 1] per pair.
void constant_indicator(const vector<double> &coupling, std::int64_t n_harmonics, ContactIndicator &out);

/// Entry (row, column) of J(s) from one pair's averages.
double indicator_entry(const double *averages, std::int64_t row, std::int64_t column);

/// force = k J(s) u for every pair; u and force are Z x (2H + 1).
void apply_indicator(const ContactIndicator &s, const vector<double> &stiffness, const Matrix &u,
                     Matrix &force);

} // namespace plm
