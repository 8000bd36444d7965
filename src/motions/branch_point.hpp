// One point of a response curve: Fourier coefficients in reduced coordinates.
#pragma once
#include "linalg/dense.hpp"
#include "linalg/status.hpp"
#include "motions/point_motion.hpp"
#include <complex>
#include <memory>

namespace plm {

/// Coordinates of one point: static part (r_0) and cosine/sine parts (r x 2H), all a caller can ask follows
/// from it.
struct BranchPoint {
    double omega = 0;             // rad/s, of the excitation
    vector<double> eta_0;         // r_0
    Matrix eta;                   // r x 2H: columns a1, b1, a2, b2, ...
    std::int64_t n_harmonics = 0; // solved for; further columns are zero or the tail that follows from them
    double harmonic_tail = -1;    // share of the gaps' motion in the next harmonics, from the exact force
    double harmonic_error = -1;   // what they would change, see harmonic_error(); -1: unknown. Of an exact
                                  // motion: what its coefficients leave out
    double force_scale = 1;       // factor on the excitation
    std::int64_t period_multiple = 1; // periods of the excitation in one of the motion
    double damping_ratio = 0;         // of a nonlinear mode, see Branch::is_mode
    std::int32_t bifurcation = bifurcation::none;
    vector<std::complex<double>> multipliers; // Floquet multipliers; empty: not computed
    double multiplier_error = 0;              // of the largest one's modulus, by the basis
    // Compliance formulation only (formulation.hpp): Z x (2H + 1) polynomials and their stiffness, whose
    // positive part gives the contact force; null: the penetration and k_n
    Matrix contact_motion;
    std::shared_ptr<const vector<double>> contact_stiffness;
    double arclength = 0;         // scaled, from the branch's first point
    double residual = 0;          // relative residual reached
    std::int64_t iterations = 0;  // Newton iterations spent
    std::int64_t n_switching = 0; // pairs that open and close in the period
    /// Not null: a solution of the exact flow, of which the coefficients are those of its first harmonics.
    std::shared_ptr<const PointMotion> motion;
};

/// +1 stable (all multipliers inside the unit circle), 0 unstable, -1 not computed, or nearer to the circle
/// than the multipliers are certain.
std::int64_t stability_of(const BranchPoint &point);

/// Two functions that change sign at a period doubling (a multiplier at -1) and at a Neimark-Sacker point:
/// the first complex pair crosses the unit circle (not a further one beside it). NaN without multipliers.
vector<double> bifurcation_tests(const vector<std::complex<double>> &multipliers);

/// The same coefficients with n harmonics: padded with zeros or cut.
void set_harmonics(Matrix &eta, std::int64_t n);

/// |x - x'| over the dynamic part and |omega - omega'|, both relative; small for the same solution.
double solution_distance(const BranchPoint &a, const BranchPoint &b);
/// Less apart, two that were found in two ways are one: far more than they are computed to.
inline constexpr double same_response = 1e-4;

/// The motion a + t (b - a), at that frequency; all else is a's.
BranchPoint between(const BranchPoint &a, const BranchPoint &b, double t);

/// The same motion on a period `multiple` times as long: harmonic h becomes multiple x h.
BranchPoint on_longer_period(const BranchPoint &point, std::int64_t multiple);

} // namespace plm
