// The equations that the points of a curve solve, whichever they are: of harmonic balance, or of exact
// motions.
#pragma once
#include "hbm/branch.hpp"
#include "hbm/options.hpp"
#include "paths/metric.hpp"

namespace plm {

class PointEquations {
  public:
    virtual ~PointEquations() = default;
    virtual Residual &residual() = 0;
    virtual vector<double> unknowns(const BranchPoint &point) const = 0;
    /// Of a solution just found.
    virtual BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations) = 0;
    /// Floquet multipliers of a solution just made a point; empty: not known.
    virtual vector<std::complex<double>> multipliers(const BranchPoint &point) = 0;
};

/// Those that `point` solves; options: with the force, the period and the harmonics that it has.
std::unique_ptr<PointEquations> equations_of(std::shared_ptr<const ReducedModel> reduced,
                                             const HbmOptions &options, const BranchPoint &point);

} // namespace plm
