#include "searches/point_equations.hpp"
#include "orbits/exact_equations.hpp"

namespace plm {

std::unique_ptr<PeriodicEquations> make_equations(std::shared_ptr<const ReducedModel> reduced,
                                                  const HbmOptions &options, MotionsAre kind, double omega,
                                                  MultipliersOf multipliers) {
    if (kind == MotionsAre::exact)
        return std::make_unique<ExactEquations>(std::move(reduced), options, omega);
    return std::make_unique<HarmonicEquations>(std::move(reduced), options, omega, std::move(multipliers));
}

std::unique_ptr<PeriodicEquations> equations_of(std::shared_ptr<const ReducedModel> reduced,
                                                const HbmOptions &options, const BranchPoint &point,
                                                StabilityOf of) {
    const MotionsAre kind = kind_of(point);
    return make_equations(reduced, options, kind, point.omega,
                          kind == MotionsAre::harmonic ? multipliers_of(reduced, options, of) : nullptr);
}

MultipliersOf multipliers_of(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                             StabilityOf of) {
    auto stability = std::make_shared<Stability>(std::move(reduced), options, of);
    if (!stability->wanted()) return nullptr;
    return stability;
}

vector<std::complex<double>> multipliers_at(PeriodicEquations &equations, const BranchPoint &point) {
    if (!equations.has_multipliers()) return {};
    const vector<double> x = equations.unknowns(point);
    vector<double> r(x.size());
    equations.residual(x.data(), point.omega, r.data());
    equations.linearize();
    return equations.multipliers(x, point.omega);
}

} // namespace plm
