// Exact motions beside points of a curve, and from one to another.
#pragma once
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"
#include "motions/options.hpp"
#include "orbits/orbit_equations.hpp"
#include "orbits/transient.hpp"
#include "paths/newton.hpp"

namespace plm {

/// Unknowns are measured at `omega`, where the flow's model is made, too; unless `known`, if not null, is an
/// exact motion of the same model, without structural damping: with the contact sets of its flow then.
OrbitEquations orbit_equations(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                               double omega, FlowParameter parameter, const BranchPoint *known = nullptr);
/// Others of the same model, without structural damping or at the same frequency: with the modes of the
/// contact sets that those have come by.
OrbitEquations orbit_equations(const OrbitEquations &known, const MotionOptions &options, double omega,
                               FlowParameter parameter);

/// From the state x by marching to a stable motion, then Newton's method. False: none was found.
bool march_to_orbit(OrbitEquations &equations, const MotionOptions &options, double omega,
                    std::int64_t transient_periods, Watch watch, vector<double> &x, NewtonOutcome &out);

/// Where Newton's method does not contract.
enum class ElseMarching { yes, no };
/// The exact motion beside a point of harmonic balance at its frequency, with its multipliers. False: none
/// was found; `point` has not changed.
bool make_exact(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options, Watch watch,
                BranchPoint &point, NewtonWork &work, ElseMarching otherwise = ElseMarching::yes);
/// The same at the frequency that goes with it, by the shortest way: where a fold is near, and another motion
/// or none may have the point's frequency.
bool make_exact_nearest(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                        BranchPoint &point, NewtonWork &work);

/// The same from a state of the model's flow at point.omega.
bool make_exact_beside(std::shared_ptr<const ReducedModel> whole, const MotionOptions &options,
                       const PointStart &start, BranchPoint &point, NewtonWork &work);

/// Along the exact motions from a point that is one to another frequency; short of folds only.
bool follow_exactly_to(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                       const BranchPoint &from, double omega, Watch watch, BranchPoint &point,
                       NewtonWork &work);

/// A curve on a compressed model as one of the whole basis, where what goes beyond the curve belongs: exact
/// motions at its points [first, last], Fourier coefficients at the others. Any other branch as it is; it has
/// to live as long then.
std::shared_ptr<const Branch> on_whole_basis(const Branch &branch, const MotionOptions &options,
                                             std::int64_t first, std::int64_t last);

} // namespace plm
