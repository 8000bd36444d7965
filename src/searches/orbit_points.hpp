// Points of a curve that are exact motions: orbits of the flow with the Fourier coefficients of their first
// harmonics, and when they are taken in the place of harmonic balance.
#pragma once
#include "hbm/branch.hpp"
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "orbits/orbit_equations.hpp"
#include "orbits/transient.hpp"
#include "paths/newton.hpp"

namespace plm {

/// Whether curves of this model are made of exact motions. Throws for motion = exact where other options, or
/// the model, speak against it.
bool prefers_exact(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options);

/// What a step of Newton's method for an exact motion costs, estimated.
double exact_step_flops(const ReducedModel &model, const HbmOptions &options);

/// Whether a period of the slowest mode takes minutes where the flow has to go by series, whose pieces are no
/// longer than the fastest decay: where damping couples the modes, or leaves their eigenvectors no digits.
bool decays_hopelessly(const ReducedModel &model);

/// Unknowns are measured at `omega`, where the flow's model is made, too.
OrbitEquations orbit_equations(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                               double omega, FlowParameter parameter);
/// Others of the same model, without structural damping or at the same frequency: with the modes of the
/// contact sets that those have come by.
OrbitEquations orbit_equations(const OrbitEquations &known, const HbmOptions &options, double omega,
                               FlowParameter parameter);

/// The state at the beginning of the period, of an exact motion or of harmonic balance.
FlowState start_of(const FlowModel &model, const BranchPoint &point, std::int64_t period_multiple);
PointStart start_of(const Branch &branch, std::int64_t point);
/// The unknowns of a point, of an exact motion or of harmonic balance.
vector<double> orbit_unknowns(const OrbitEquations &equations, const BranchPoint &point,
                              std::int64_t period_multiple);

/// From the state x by marching to a stable motion, then Newton's method. False: none was found.
bool march_to_orbit(OrbitEquations &equations, const HbmOptions &options, double omega,
                    std::int64_t transient_periods, Watch watch, vector<double> &x, NewtonOutcome &out);

/// A solution as a point: as many harmonics as describe its motion to a tenth of harmonic_tolerance, no more
/// than max_harmonics. Multipliers are not set.
BranchPoint orbit_point(const OrbitEquations &equations, const HbmOptions &options, const PathState &at,
                        double residual, std::int64_t iterations);

/// Where Newton's method does not contract.
enum class ElseMarching { yes, no };
/// The exact motion beside a point of harmonic balance at its frequency, with its multipliers. False: none
/// was found; `point` has not changed.
bool make_exact(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, Watch watch,
                BranchPoint &point, NewtonWork &work, ElseMarching otherwise = ElseMarching::yes);
/// The same at the frequency that goes with it, by the shortest way: where a fold is near, and another motion
/// or none may have the point's frequency.
bool make_exact_nearest(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                        BranchPoint &point, NewtonWork &work);

/// The same from a state of the model's flow at point.omega.
bool make_exact_beside(std::shared_ptr<const ReducedModel> whole, const HbmOptions &options,
                       const PointStart &start, BranchPoint &point, NewtonWork &work);

/// Along the exact motions from a point that is one to another frequency; short of folds only.
bool follow_exactly_to(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                       const BranchPoint &from, double omega, Watch watch, BranchPoint &point,
                       NewtonWork &work);

} // namespace plm
