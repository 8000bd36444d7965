#include "searches/orbit_points.hpp"
#include "hbm/branch_path.hpp"
#include "hbm/free_motion.hpp"
#include "hbm/make_system.hpp"
#include "orbits/recorded_motion.hpp"
#include "orbits/shooting.hpp"
#include "reduction/compression.hpp"
#include "reduction/reduced_rest.hpp"
#include "reduction/widened_model.hpp"
#include "searches/exact_motion.hpp"
#include "searches/harmonic_choice.hpp"
#include "searches/start.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// What the harmonics of an exact motion may leave out, of harmonic_tolerance: those that harmonic balance
// would go on with, and those of the coefficients handed out, whose derivatives are read, too. At the gaps,
// whose local motion hardly acts back, more. No less than the motion itself is off by.
constexpr double of_solution = 0.1, of_coefficients = 0.01, at_gaps_more = 20;
constexpr std::int64_t harmonics_at_once = 8;

constexpr std::int64_t usual_harmonics = 20; // of points near a resonance
constexpr double hopeless_period = 3e9;      // flops: a curve takes many minutes
constexpr double cheap_step = 5e7;           // flops: a curve takes seconds

class OrbitMotion final : public PointMotion {
  public:
    OrbitMotion(std::shared_ptr<const FlowModel> model, std::shared_ptr<ContactModesKept> modes,
                FlowState start, const OrbitConditions &conditions, vector<double> closed_shares)
        : model_(std::move(model)), modes_(std::move(modes)), start_(std::move(start)),
          conditions_(conditions), closed_shares_(std::move(closed_shares)) {}

    const FlowState &start() const { return start_; }

    ValueRange range(std::int64_t dof) const override {
        if (dof != known_dof_) {
            known_range_ = range_of_flow(model_->dof_row(dof));
            known_dof_ = dof;
        }
        return known_range_;
    }

    ValueRange range_of(const vector<double> &row) const override {
        return range_of_flow(model_->from_static_coordinates(row));
    }

    vector<double> displacement(double fraction) const override {
        return model_->in_static_coordinates(run(fraction - std::floor(fraction), nullptr).y);
    }

    Matrix contact_forces(std::int64_t n_harmonics) const override {
        RecordedMotion motion;
        run(1, &motion);
        const RecordedMotion forces = motion.contact_forces(*model_);
        const vector<double> mean = forces.mean();
        const Matrix harmonics = forces.harmonics(1, n_harmonics);
        Matrix all(static_cast<std::int64_t>(mean.size()), 2 * n_harmonics + 1);
        std::copy(mean.begin(), mean.end(), all.data());
        std::copy(harmonics.data(), harmonics.col(harmonics.cols()), all.col(1));
        return all;
    }

    const vector<double> &closed_shares() const override { return closed_shares_; }

  private:
    ValueRange range_of_flow(const vector<double> &row) const {
        RecordedMotion motion;
        run(1, &motion);
        Matrix rows(1, model_->size());
        std::copy(row.begin(), row.end(), rows.data());
        return motion.ranges(rows)[0];
    }

    FlowState run(double periods, FlowRecorder *recorder) const {
        ExactFlow flow = conditions_.flow(model_, modes_);
        FlowState state = start_;
        flow.advance(state, periods * static_cast<double>(conditions_.period_multiple) * flow.period(),
                     recorder);
        return state;
    }

    std::shared_ptr<const FlowModel> model_;
    std::shared_ptr<ContactModesKept> modes_;
    FlowState start_;
    OrbitConditions conditions_;
    vector<double> closed_shares_;
    mutable std::int64_t known_dof_ = -1; // of the last range(): curves are asked for one DOF at a time
    mutable ValueRange known_range_ = {};
};

// Of the motion, of the gaps together and of each of them: mean squares, of all and of what the harmonics so
// far leave out.
struct Remainder {
    double all, gaps, left, left_at_gaps;
    vector<double> at_pair, left_at_pair;

    bool is_within(double share) const {
        return left <= share * share * all &&
               left_at_gaps <= share * share * at_gaps_more * at_gaps_more * gaps;
    }
    void take(const Matrix &harmonics, const Matrix &at_gaps) {
        for (std::int64_t k = 0; k < harmonics.cols(); ++k) {
            left -= 0.5 * dot(harmonics.rows(), harmonics.col(k), harmonics.col(k));
            left_at_gaps -= 0.5 * dot(at_gaps.rows(), at_gaps.col(k), at_gaps.col(k));
            for (std::int64_t i = 0; i < at_gaps.rows(); ++i)
                left_at_pair[i] -= 0.5 * at_gaps(i, k) * at_gaps(i, k);
        }
    }
    /// The largest share, of the motion or of a pair's, as harmonic_error() counts them.
    double largest_share() const {
        constexpr double least_motion = 0.03; // of the pair that moves most
        constexpr double rounding = 1e-14;    // of differences of squares
        const double most = at_pair.empty() ? 0 : *std::max_element(at_pair.begin(), at_pair.end());
        double share = all > 0 ? left / all : 0;
        for (std::size_t i = 0; i < at_pair.size() && most > 0; ++i)
            share =
                std::max(share, left_at_pair[i] / std::max(at_pair[i], least_motion * least_motion * most));
        return share > rounding ? std::sqrt(share) : 0;
    }
};

Remainder mean_squares(const Matrix &covariance, const Matrix &gap) {
    const Matrix at_gaps = product('N', 'N', gap, covariance);
    double all = 0, gaps = 0;
    for (std::int64_t j = 0; j < covariance.cols(); ++j) all += covariance(j, j);
    vector<double> at_pair(static_cast<std::size_t>(gap.rows()), 0.0);
    for (std::int64_t j = 0; j < gap.cols(); ++j)
        for (std::int64_t i = 0; i < gap.rows(); ++i) at_pair[i] += gap(i, j) * at_gaps(i, j);
    for (double &square : at_pair) gaps += square = std::max(0.0, square);
    return {all, gaps, all, gaps, at_pair, at_pair};
}

// Mean and harmonics in the coordinates of the basis.
void put_harmonics(const FlowModel &model, const RecordedMotion &motion, const HbmOptions &options,
                   BranchPoint &point) {
    point.eta_0 = model.in_static_coordinates(motion.mean());
    Remainder rest = mean_squares(motion.covariance(), model.gap());
    const std::int64_t fewest = few_harmonics(model.reduced()) * options.period_multiple,
                       most = std::max(fewest, options.max_harmonics * options.period_multiple);
    const double enough = std::max(of_coefficients * options.allowed_harmonic_error(), options.tolerance);
    const auto told = [&] {
        return rest.gaps > 0 ? std::sqrt(std::max(rest.left_at_gaps, 0.0) / rest.gaps) : 0.0;
    };
    point.n_harmonics = 0;
    Matrix eta;
    while (eta.cols() < 2 * most) {
        if (eta.cols() >= 2 * fewest && point.n_harmonics == 0 &&
            rest.is_within(of_solution * options.allowed_harmonic_error())) {
            point.n_harmonics = eta.cols() / 2;
            point.harmonic_tail = told();
        }
        if (point.n_harmonics > 0 && rest.is_within(enough)) break;
        const std::int64_t known = eta.cols() / 2,
                           more = std::min(most - known, known == 0 ? fewest : harmonics_at_once);
        const Matrix next = motion.harmonics(known + 1, more);
        rest.take(next, product('N', 'N', model.gap(), next));
        eta.append(next);
    }
    if (point.n_harmonics == 0) {
        point.n_harmonics = eta.cols() / 2;
        point.harmonic_tail = told();
    }
    for (std::int64_t k = 0; k < eta.cols(); ++k) {
        const vector<double> turned =
            model.in_static_coordinates(vector<double>(eta.col(k), eta.col(k) + eta.rows()));
        std::copy(turned.begin(), turned.end(), eta.col(k));
    }
    point.eta = std::move(eta);
    point.harmonic_error = rest.largest_share();
}

FlowState rest_state(const FlowModel &model) {
    return {model.from_static_coordinates(rest_of(model.reduced())->coordinates),
            vector<double>(static_cast<std::size_t>(model.size()), 0.0), 0};
}

OrbitConditions orbit_conditions(const HbmOptions &options, double omega) {
    return {omega, options.force_scale, options.period_multiple, options.tolerance};
}

// Rigid-body motion that no pair ever holds has no place of its own: harmonic balance keeps its mean.
bool moves_freely(const OrbitEquations &equations, const ReducedModel &reduced) {
    vector<char> acting(static_cast<std::size_t>(reduced.n_pairs()), 0);
    for (const ContactInterval &interval : equations.intervals())
        for (std::int64_t pair : interval.states.closed_pairs()) acting[static_cast<std::size_t>(pair)] = 1;
    return free_motion(reduced, acting).cols() > 0;
}

constexpr double near_enough = 0.3; // of its size: farther away it is another one

// By Newton's method from the point; by marching where that does not contract.
bool solve_exact(OrbitEquations &equations, const HbmOptions &options, Watch watch, const BranchPoint &point,
                 vector<double> &x, NewtonOutcome &out, ElseMarching otherwise) {
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

// Every pair switches a few times in a period, and each event costs a product with the propagator of its
// contact set, now and then the modes of a new one, and some pieces of the flow.
double exact_step_flops(const ReducedModel &m, const HbmOptions &o) {
    // measured at 37 coordinates and 15 pairs, 47 and 90, 110 and 32: 6, 84 and 100 ms at 3 Gflop/s
    constexpr double events_per_pair = 3, pieces_per_event = 5, terms = 6, cubes = 2;
    constexpr double least_piece = 3e4; // what a piece of the smallest system takes, in time
    const double n = static_cast<double>(m.static_size()), z = static_cast<double>(m.n_pairs()),
                 events = events_per_pair * z * static_cast<double>(o.period_multiple),
                 per_event = cubes * n * n * n, per_piece = least_piece + 4 * terms * n * (n + z);
    return events * (per_event + pieces_per_event * per_piece);
}

bool decays_hopelessly(const ReducedModel &m) {
    constexpr double terms = 26, radians = 2;
    const auto slowest = std::find_if(m.lambda.begin(), m.lambda.end(), [](double l) { return l > 0; });
    if (slowest == m.lambda.end()) return false;
    double rate = 0;
    for (std::int64_t j = 0; j < m.size() - m.n_massless; ++j)
        rate = std::max(rate, m.damping.empty() ? m.damping_diagonal[j] : m.damping(j, j));
    const double n = static_cast<double>(m.size()), z = static_cast<double>(m.n_pairs()),
                 pieces = rate * 2 * M_PI / std::sqrt(*slowest) / radians;
    return pieces * terms * 2 * n * (n + z) > hopeless_period;
}

bool prefers_exact(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &o) {
    if (o.motion == MotionKind::harmonics) return false;
    const bool asked = o.motion == MotionKind::exact;
    const auto refuse = [&](const char *argument, const std::string &why) {
        if (asked) throw Error(PLM_ERR_ARGUMENT, why).argument(argument);
        return false;
    };
    if (reduced->structural != 0)
        return refuse("motion",
                      "structural damping has no exact motion in time; set motion to auto or harmonics");
    if (o.aft == AftKind::sampled)
        return refuse("aft", "an exact motion has no time samples; set aft to event, or motion to harmonics");
    if (o.stability == StabilityKind::hill)
        return refuse("stability", "Hill's method is one of harmonics; set stability to floquet");
    if (asked) return true;
    if (o.n_harmonics != 0 || o.tail_correction || o.unknowns != NonlinearUnknowns::automatic ||
        o.formulation != FormulationKind::automatic || reduced->n_pairs() == 0)
        return false;
    if (!reduced->damping.empty() && decays_hopelessly(*reduced)) return false; // no modes to go by
    return exact_step_flops(*reduced, o) <
           std::max(cheap_step, harmonic_step_flops(*reduced, usual_harmonics));
}

bool march_to_orbit(OrbitEquations &equations, const HbmOptions &options, double omega,
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
        if (e.status() != PLM_ERR_CONVERGENCE) throw;
        return false;
    }
    out = newton_at(equations, newton_limits(options), x, omega);
    return out.converged;
}

OrbitEquations orbit_equations(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                               double omega, FlowParameter parameter) {
    auto model = std::make_shared<const FlowModel>(std::move(reduced), omega);
    FlowState rest = rest_state(*model);
    return OrbitEquations(std::move(model), std::move(rest), orbit_conditions(options, omega), parameter);
}

OrbitEquations orbit_equations(const OrbitEquations &known, const HbmOptions &options, double omega,
                               FlowParameter parameter) {
    return known.beside(orbit_conditions(options, omega), parameter);
}

FlowState start_of(const FlowModel &model, const BranchPoint &point, std::int64_t period_multiple) {
    if (const auto *motion = dynamic_cast<const OrbitMotion *>(point.motion.get())) return motion->start();
    return model.state(point.eta_0, point.eta, point.omega / static_cast<double>(period_multiple), 0.0);
}

PointStart start_of(const Branch &branch, std::int64_t point) {
    const BranchPoint &p = branch.points()[static_cast<std::size_t>(point)];
    const FlowModel model(branch.reduced_model(), p.omega);
    FlowState state = start_of(model, p, branch.period_multiple());
    if (!branch.reduced().from) return {branch.reduced_model(), state};
    const auto whole = uncompressed(branch.reduced_model());
    const FlowModel flow_model(whole, p.omega);
    for (vector<double> *y : {&state.y, &state.v}) {
        vector<double> in_whole(flow_model.size(), 0.0);
        gemv('N', 1.0, branch.reduced().from->coordinates, model.in_static_coordinates(*y).data(), 0.0,
             in_whole.data());
        *y = flow_model.from_static_coordinates(in_whole);
    }
    return {whole, state};
}

vector<double> orbit_unknowns(const OrbitEquations &equations, const BranchPoint &point,
                              std::int64_t period_multiple) {
    return equations.unknowns(start_of(equations.model(), point, period_multiple));
}

BranchPoint orbit_point(const OrbitEquations &equations, const HbmOptions &options, const PathState &at,
                        double residual, std::int64_t iterations) {
    const OrbitConditions conditions = equations.conditions(at.parameter);
    RecordedMotion motion;
    ExactFlow flow = conditions.flow(equations.shared_model(), equations.modes());
    FlowState start = equations.state(at.x.data());
    flow.complete(start); // what follows without mass is no unknown
    FlowState state = start;
    flow.advance(state, static_cast<double>(conditions.period_multiple) * flow.period(), &motion);
    BranchPoint point;
    point.omega = conditions.omega;
    point.force_scale = conditions.force_scale;
    put_harmonics(equations.model(), motion, options, point);
    put_record(residual, iterations, motion.n_switching(), point);
    point.motion = std::make_shared<OrbitMotion>(equations.shared_model(), equations.modes(), start,
                                                 conditions, motion.closed_shares());
    return point;
}

namespace {

// The tangent at a solution just found. False: it leaves a motion free, whose place is then arbitrary.
bool holds(OrbitEquations &equations) {
    constexpr double free_to_go = 1e-11;
    equations.linearize();
    return equations.reciprocal_condition() > free_to_go;
}

// A solution where the tangent is known, with its multipliers.
BranchPoint whole_point(OrbitEquations &equations, const HbmOptions &options, const PathState &at,
                        const NewtonOutcome &out) {
    BranchPoint point = orbit_point(equations, options, at, out.residual, out.iterations);
    if (options.stability != StabilityKind::off) point.multipliers = equations.multipliers();
    return point;
}

// Where no pair ever holds a rigid-body motion.
bool has_no_place(const ReducedModel &reduced, const HbmOptions &options, const BranchPoint &point) {
    const EventSequence sequence = contact_events(reduced, point, options.period_multiple);
    return free_motion(reduced, sequence.acting()).cols() > 0;
}

// The solution as the point, if it is one that stays where it is.
bool take_exact(OrbitEquations &equations, const HbmOptions &options, const PathState &at, NewtonOutcome out,
                const ReducedModel &reduced, BranchPoint &point) {
    if (moves_freely(equations, reduced) || !holds(equations)) return false;
    out.iterations += point.iterations;
    point = whole_point(equations, options, at, out);
    return true;
}

} // namespace

namespace {

// Across the tangent where it begins; again across that where it got to, as a tangent off the solution is not
// that of the curve.
bool correct_across(OrbitEquations &equations, const HbmOptions &options, vector<double> start,
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

bool make_exact(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, Watch watch,
                BranchPoint &point, NewtonWork &work, ElseMarching otherwise) {
    if (has_no_place(*reduced, options, point)) return false;
    OrbitEquations equations = orbit_equations(reduced, options, point.omega, FlowParameter::frequency);
    vector<double> x;
    NewtonOutcome out;
    const bool found = solve_exact(equations, options, watch, point, x, out, otherwise);
    work += out;
    return found && take_exact(equations, options, {x, point.omega}, out, *reduced, point);
}

bool make_exact_nearest(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                        BranchPoint &point, NewtonWork &work) {
    if (has_no_place(*reduced, options, point)) return false;
    OrbitEquations equations = orbit_equations(reduced, options, point.omega, FlowParameter::frequency);
    return correct_across(equations, options, orbit_unknowns(equations, point, options.period_multiple),
                          *reduced, point, work);
}

bool make_exact_beside(std::shared_ptr<const ReducedModel> whole, const HbmOptions &options,
                       const PointStart &start, BranchPoint &point, NewtonWork &work) {
    OrbitEquations equations = orbit_equations(whole, options, point.omega, FlowParameter::frequency);
    return correct_across(equations, options, equations.unknowns(start.state), *whole, point, work);
}

bool follow_exactly_to(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
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
        if (out.end_reason != PLM_REASON_RANGE_END || out.at.parameter != omega) return false;
        at = out.at;
    }
    const NewtonOutcome out = newton_at(equations, newton_limits(options), at.x, omega);
    work += out;
    if (!out.converged || !holds(equations)) return false;
    point = whole_point(equations, options, {at.x, omega}, out);
    return true;
}

} // namespace plm
