// How many modes lie below a frequency, by Sylvester's law of inertia: one factorization, none is missed.
#pragma once
#include "linalg/monitor.hpp"
#include "structure/solver/factor.hpp"
#include "structure/tall.hpp"

namespace plm {

/// No count: the solver cannot tell, or omega hits a mode.
constexpr std::int64_t cannot_tell_count = -1, hit_a_mode = -2;

/// An eigenvalue so near to the one counted at may be in the count or not: what rounding and the tolerance of
/// a search leave, relative.
constexpr double count_rounding = 1e-8;

/// Eigenvalues of K x = lambda M x below omega^2 (rad/s), or one of the two above.
std::int64_t count_modes(const TallMatrix &k, const TallMatrix &m, double omega, const Solver &solver);

/// The same, where omega may move up a little out of a mode's way. Where it meets one all the same a warning
/// says so: of which modes, and what to change.
std::int64_t count_modes_near(const TallMatrix &k, const TallMatrix &m, double &omega, const Solver &solver,
                              const char *which, const char *remedy, Watch watch);

} // namespace plm
