#include "orbits/orbit_points.hpp"
#include "motions/branch_path.hpp"
#include "motions/compressed_motion.hpp"
#include "motions/free_motion.hpp"
#include "orbits/exact_motion.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/recorded_motion.hpp"
#include "orbits/shooting.hpp"
#include "paths/quiet_owner.hpp"
#include "reduction/reduced_rest.hpp"
#include "reduction/widened_model.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

FlowState rest_state(const FlowModel &model) {
    return {model.from_static_coordinates(rest_of(model.reduced())->coordinates),
            vector<double>(static_cast<std::size_t>(model.size()), 0.0), 0};
}

OrbitConditions orbit_conditions(const MotionOptions &options, double omega) {
    return {omega, options.force_scale, options.period_multiple, options.tolerance};
}

// Rigid-body motion that no pair ever holds has no place of its own: harmonic balance keeps its mean.
bool moves_freely(const OrbitEquations &equations, const ReducedModel &reduced) {
    return free_motion(reduced, acting_pairs(equations.intervals(), reduced.n_pairs())).cols() > 0;
}

constexpr double near_enough = 0.3; // of its size: farther away it is another one

// By Newton's method from the point; by marching where that does not contract.
bool solve_exact(OrbitEquations &equations, const MotionOptions &options, Watch watch,
                 const BranchPoint &point, vector<double> &x, NewtonOutcome &out, ElseMarching otherwise) {
    x = orbit_unknowns(equations, point, options.period_multiple);
    const vector<double> guess = x;
    out = newton_at(equations, newton_limits(options), x, point.omega);
    double far = 0;
    for (std::size_t i = 0; i < x.size(); ++i) far = std::hypot(far, x[i] - guess[i]);
    if (out.converged && far <= near_enough * norm2(equations.size(), x.data())) return true;
    if (otherwise == ElseMarching::no) return false;
    constexpr std::int64_t settling = 20; // periods: on a stable branch, as most of the starts are
    x = guess;
    return march_to_orbit(equations, options, point.omega, settling, watch, x, out);
}

} // namespace

bool march_to_orbit(OrbitEquations &equations, const MotionOptions &options, double omega,
                    std::int64_t transient_periods, Watch watch, vector<double> &x, NewtonOutcome &out) {
    ExactFlow flow(equations.shared_model(), omega, options.force_scale, watch, equations.modes());
    ShootingOptions shooting;
    shooting.period_multiple = options.period_multiple;
    shooting.transient_periods = transient_periods * options.period_multiple;
    try {
        const PeriodicOrbit orbit = periodic_orbit(flow, equations.state(x.data()), shooting);
        if (!orbit.converged) return false;
        x = equations.unknowns(orbit.state);
    } catch (const Error &e) { // chatter
        if (e.status() != status::convergence) throw;
        return false;
    }
    out = newton_at(equations, newton_limits(options), x, omega);
    return out.converged;
}

OrbitEquations orbit_equations(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                               double omega, FlowParameter parameter, const BranchPoint *known) {
    PointFlow flow = known ? flow_of(*known) : PointFlow();
    if (!flow.model || &flow.model->reduced() != reduced.get())
        flow = {std::make_shared<const FlowModel>(std::move(reduced), omega), nullptr};
    FlowState rest = rest_state(*flow.model);
    return OrbitEquations(std::move(flow.model), std::move(rest), orbit_conditions(options, omega), parameter,
                          std::move(flow.modes));
}

OrbitEquations orbit_equations(const OrbitEquations &known, const MotionOptions &options, double omega,
                               FlowParameter parameter) {
    return known.beside(orbit_conditions(options, omega), parameter);
}

namespace {

// The tangent at a solution just found. False: it leaves a motion free, whose place is then arbitrary.
bool holds(OrbitEquations &equations) {
    constexpr double free_to_go = 1e-11;
    equations.linearize();
    return equations.reciprocal_condition() > free_to_go;
}

// A solution where the tangent is known, with its multipliers.
BranchPoint whole_point(OrbitEquations &equations, const MotionOptions &options, const PathState &at,
                        const NewtonOutcome &out) {
    BranchPoint point = orbit_point(equations, options, at, out.residual, out.iterations);
    if (options.stability != StabilityKind::off) point.multipliers = equations.multipliers();
    return point;
}

// Where no pair ever holds a rigid-body motion.
bool has_no_place(const ReducedModel &reduced, const MotionOptions &options, const BranchPoint &point) {
    const EventSequence sequence = contact_events(reduced, point, options.period_multiple);
    return free_motion(reduced, sequence.acting()).cols() > 0;
}

// The solution as the point, if it is one that stays where it is.
bool take_exact(OrbitEquations &equations, const MotionOptions &options, const PathState &at,
                NewtonOutcome out, const ReducedModel &reduced, BranchPoint &point) {
    if (moves_freely(equations, reduced) || !holds(equations)) return false;
    out.iterations += point.iterations;
    point = whole_point(equations, options, at, out);
    return true;
}

} // namespace

namespace {

// Across the tangent where it begins; again across that where it got to, as a tangent off the solution is not
// that of the curve.
bool correct_across(OrbitEquations &equations, const MotionOptions &options, vector<double> start,
                    const ReducedModel &reduced, BranchPoint &point, NewtonWork &work) {
    const PathState from = {std::move(start), point.omega};
    const Metric metric = {size_of(equations, from.x), point.omega, equations.weights()};
    if (!(metric.scale > 0)) return false;
    PathState at = from;
    NewtonOutcome all;
    for (int pass = 0; pass < 2; ++pass) {
        vector<double> r(at.x.size());
        equations.residual(at.x.data(), at.parameter, r.data());
        equations.linearize();
        PathState direction = tangent_at(equations);
        scale_by(1 / metric.length(direction), direction);
        const double along = metric.product(direction, difference(from, at));
        PathState foot = direction;
        scale_by(along, foot);
        add(1, foot, at);
        const NewtonOutcome out = newton_across(equations, metric, direction, newton_limits(options), at);
        work += out;
        all = out;
        if (!out.converged || metric.distance(at, from) > near_enough) return false;
    }
    return take_exact(equations, options, at, all, reduced, point);
}

} // namespace

bool make_exact(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options, Watch watch,
                BranchPoint &point, NewtonWork &work, ElseMarching otherwise) {
    if (has_no_place(*reduced, options, point)) return false;
    OrbitEquations equations = orbit_equations(reduced, options, point.omega, FlowParameter::frequency);
    vector<double> x;
    NewtonOutcome out;
    const bool found = solve_exact(equations, options, watch, point, x, out, otherwise);
    work += out;
    return found && take_exact(equations, options, {x, point.omega}, out, *reduced, point);
}

bool make_exact_nearest(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                        BranchPoint &point, NewtonWork &work) {
    if (has_no_place(*reduced, options, point)) return false;
    OrbitEquations equations = orbit_equations(reduced, options, point.omega, FlowParameter::frequency);
    return correct_across(equations, options, orbit_unknowns(equations, point, options.period_multiple),
                          *reduced, point, work);
}

bool make_exact_beside(std::shared_ptr<const ReducedModel> whole, const MotionOptions &options,
                       const PointStart &start, BranchPoint &point, NewtonWork &work) {
    OrbitEquations equations = orbit_equations(whole, options, point.omega, FlowParameter::frequency);
    return correct_across(equations, options, equations.unknowns(start.state), *whole, point, work);
}

bool follow_exactly_to(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                       const BranchPoint &from, double omega, Watch watch, BranchPoint &point,
                       NewtonWork &work) {
    OrbitEquations equations = orbit_equations(reduced, options, from.omega, FlowParameter::frequency);
    PathState at = {orbit_unknowns(equations, from, options.period_multiple), from.omega};
    if (omega != from.omega) {
        PathOptions path = path_options(options, std::min(from.omega, omega), std::max(from.omega, omega));
        path.upward = omega > from.omega;
        QuietOwner quiet(watch);
        const PathOutcome out = follow_path(equations, path, {at}, quiet);
        work += out.work;
        if (out.end_reason != reason::range_end || out.at.parameter != omega) return false;
        at = out.at;
    }
    const NewtonOutcome out = newton_at(equations, newton_limits(options), at.x, omega);
    work += out;
    if (!out.converged || !holds(equations)) return false;
    point = whole_point(equations, options, {at.x, omega}, out);
    return true;
}

std::shared_ptr<const Branch> on_whole_basis(const Branch &branch, const MotionOptions &options,
                                             std::int64_t first, std::int64_t last) {
    const ReducedModel &m = branch.reduced();
    if (!m.from) return {std::shared_ptr<const Branch>(), &branch};
    auto whole = std::make_shared<Branch>(m.from->model, branch.force_scale(), branch.period_multiple());
    whole->end_reason = branch.end_reason;
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(branch.points().size()); ++i) {
        const BranchPoint &p = branch.points()[static_cast<std::size_t>(i)];
        BranchPoint q = uncompressed(m, p);
        if (p.motion && i >= first && i <= last) {
            MotionOptions o = options;
            o.period_multiple = branch.period_multiple();
            o.force_scale = p.force_scale;
            const OrbitEquations equations =
                orbit_equations(m.from->model, o, p.omega, FlowParameter::frequency);
            const BranchPoint exact =
                orbit_point(equations, o, {equations.unknowns(start_of(branch, i).state), p.omega},
                            p.residual, p.iterations);
            q.eta_0 = exact.eta_0, q.eta = exact.eta, q.motion = exact.motion;
        }
        whole->append(std::move(q));
    }
    return whole;
}

} // namespace plm
