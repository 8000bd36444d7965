#include "searches/point_equations.hpp"
#include "hbm/make_system.hpp"
#include "hbm/solved_point.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/orbit_points.hpp"
#include "orbits/stability.hpp"

namespace plm {
namespace {

class HarmonicEquations final : public PeriodicEquations {
  public:
    HarmonicEquations(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options)
        : system_(make_system(reduced, options)), stability_(reduced, options) {}
    Residual &residual() override { return *system_; }
    vector<double> unknowns(const BranchPoint &point) const override { return unknowns_of(*system_, point); }
    BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations) override {
        return plm::solved_point(*system_, at, residual, iterations);
    }
    vector<std::complex<double>> multipliers(const BranchPoint &point) override {
        return stability_.wanted() ? stability_.multipliers(point) : vector<std::complex<double>>();
    }

  private:
    std::unique_ptr<HbmSystem> system_;
    Stability stability_;
};

class ExactEquations final : public PeriodicEquations {
  public:
    ExactEquations(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, double omega)
        : options_(options),
          equations_(orbit_equations(std::move(reduced), options, omega, FlowParameter::frequency)) {}
    Residual &residual() override { return equations_; }
    vector<double> unknowns(const BranchPoint &point) const override {
        return orbit_unknowns(equations_, point, options_.period_multiple);
    }
    BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations) override {
        return orbit_point(equations_, options_, at, residual, iterations);
    }
    vector<std::complex<double>> multipliers(const BranchPoint &point) override {
        if (options_.stability == StabilityKind::off) return {};
        const vector<double> x = unknowns(point);
        vector<double> r(x.size());
        equations_.residual(x.data(), point.omega, r.data());
        equations_.linearize();
        return equations_.multipliers();
    }

  private:
    const HbmOptions options_;
    OrbitEquations equations_;
};

} // namespace

std::unique_ptr<PeriodicEquations> equations_of(std::shared_ptr<const ReducedModel> reduced,
                                                const HbmOptions &options, const BranchPoint &point) {
    if (point.motion) return std::make_unique<ExactEquations>(std::move(reduced), options, point.omega);
    return std::make_unique<HarmonicEquations>(std::move(reduced), options);
}

} // namespace plm
