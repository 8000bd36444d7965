// The equations that the points of a curve solve, whichever they are: of harmonic balance, or of exact
// motions.
#pragma once
#include "motions/branch.hpp"
#include "motions/options.hpp"
#include "paths/metric.hpp"

namespace plm {

class PeriodicEquations {
  public:
    virtual ~PeriodicEquations() = default;
    virtual Residual &residual() = 0;
    virtual vector<double> unknowns(const BranchPoint &point) const = 0;
    /// Of a solution just found.
    virtual BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations) = 0;
    /// Floquet multipliers of a solution just made a point; empty: not known.
    virtual vector<std::complex<double>> multipliers(const BranchPoint &point) = 0;
};

} // namespace plm
