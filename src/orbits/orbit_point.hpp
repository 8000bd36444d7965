// An orbit of the flow as a point of a curve, with the Fourier coefficients of its first harmonics, and the
// state that a point begins its period with.
#pragma once
#include "motions/branch.hpp"
#include "motions/options.hpp"
#include "orbits/orbit_equations.hpp"
#include "orbits/transient.hpp"
#include "paths/metric.hpp"

namespace plm {

/// The state at the beginning of the period, of an exact motion or of harmonic balance.
FlowState start_of(const FlowModel &model, const BranchPoint &point, std::int64_t period_multiple);
PointStart start_of(const Branch &branch, std::int64_t point);
/// The unknowns of a point, of an exact motion or of harmonic balance.
vector<double> orbit_unknowns(const OrbitEquations &equations, const BranchPoint &point,
                              std::int64_t period_multiple);

/// A solution as a point: as many harmonics as describe its motion to a tenth of harmonic_tolerance, no more
/// than max_harmonics. Multipliers are not set.
BranchPoint orbit_point(const OrbitEquations &equations, const MotionOptions &options, const PathState &at,
                        double residual, std::int64_t iterations);

/// The flow that an exact motion is of; null: the point has none.
struct PointFlow {
    std::shared_ptr<const FlowModel> model;
    std::shared_ptr<ContactModesKept> modes;
};
PointFlow flow_of(const BranchPoint &point);

/// What an exact motion follows from, beside the point that carries it. False: the point has none.
struct KeptOrbit {
    FlowState start; // y, v at the beginning of the period
    double tolerance = 0;
    vector<double> shares; // of the period, of each pair
};
bool kept_orbit(const BranchPoint &point, KeptOrbit &kept);
/// The motion from that.
std::shared_ptr<const PointMotion> motion_of(std::shared_ptr<const FlowModel> model,
                                             std::shared_ptr<ContactModesKept> modes,
                                             const BranchPoint &point, KeptOrbit kept);

} // namespace plm
