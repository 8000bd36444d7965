// The equations that the points of a curve solve, whichever they are.
#pragma once
#include "hbm/harmonic_equations.hpp"
#include "orbits/stability.hpp"

namespace plm {

enum class MotionsAre { exact, harmonic };

/// Near the frequency omega. multipliers: of harmonic motions; exact ones have their own.
std::unique_ptr<PeriodicEquations> make_equations(std::shared_ptr<const ReducedModel> reduced,
                                                  const HbmOptions &options, MotionsAre kind, double omega,
                                                  MultipliersOf multipliers = nullptr);
/// Those that `point` solves; options: with the force, the period and the harmonics that it has.
std::unique_ptr<PeriodicEquations> equations_of(std::shared_ptr<const ReducedModel> reduced,
                                                const HbmOptions &options, const BranchPoint &point,
                                                StabilityOf of = StabilityOf::curve);
inline MotionsAre kind_of(const BranchPoint &point) {
    return point.motion ? MotionsAre::exact : MotionsAre::harmonic;
}

/// Floquet multipliers of points of harmonic balance, from the exact motion beside them; null where the
/// options or the size of the model do not ask for them.
MultipliersOf multipliers_of(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                             StabilityOf of = StabilityOf::curve);
/// Those of a solution.
vector<std::complex<double>> multipliers_at(PeriodicEquations &equations, const BranchPoint &point);

} // namespace plm
