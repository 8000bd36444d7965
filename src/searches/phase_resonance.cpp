#include "searches/phase_resonance.hpp"
#include "hbm/modes_at_rest.hpp"
#include "linalg/work.hpp"
#include "motions/motion_measures.hpp"
#include "motions/phase_system.hpp"
#include "motions/response_at_force.hpp"
#include "motions/tracer.hpp"
#include "searches/point_equations.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

enum : std::int32_t { crossing = -1 }; // kind of the test function force - force_scale
constexpr double longest_step = 0.1;   // of a backbone: extrema of the force come in close pairs
// Where a backbone ends below: upwards what is of interest begins beside the force asked for; downwards it
// comes to nothing, or turns.
constexpr double below_the_force = 0.5, next_to_nothing = 1e-3; // of the force asked for, of the start's
constexpr double about_resonance = 0.02; // relative: a corrected start farther off is another resonance

} // namespace

// --- a path of phase-resonant points

struct PhaseResonance::Followed final : public Tracer {
    Followed(const PhaseResonance &of, const BranchPoint &about, Branch &branch,
             PathParameter over = PathParameter::force)
        : Tracer("isolated branches", of.watch_, branch), options(of.options_.hbm),
          only_special(of.options_.only_special), low(2 * M_PI * options.frequency_min_hz),
          high(2 * M_PI * options.frequency_max_hz),
          equations(make_equations(of.reduced_, options,
                                   of.options_.exact ? MotionsAre::exact : MotionsAre::harmonic,
                                   about.omega)),
          scale(response_at_force(plm::size_of(*equations, equations->unknowns(about)), about, options)),
          resonant(*equations, about.omega, scale / (high - low), over), parameter(over) {}

    void run(const PathOptions &range, const PathStart &from) { follow(resonant, range, from); }
    void record(const PathPoint &p) override {
        omega = resonant.omega_of(p.x.data());
        passed.push_back(p.parameter);
        if (only_special && passed.size() > 1 && p.bifurcation == bifurcation::none) return;
        if (p.bifurcation == crossing) crossings.push_back(branch_.points().size());
        BranchPoint point = resonant.solved_point({p.x, p.parameter}, p.residual, p.iterations);
        put_place(p, point);
        if (p.bifurcation == crossing) point.bifurcation = bifurcation::none;
        point.multipliers = multipliers_at(*equations, point);
        branch_.append(std::move(point));
    }
    void test(const vector<double> &, double force, vector<double> &values) override {
        if (parameter == PathParameter::force) values = {force - options.force_scale};
    }
    vector<std::int32_t> test_kinds() const override {
        return vector<std::int32_t>(parameter == PathParameter::force ? 1 : 0, crossing);
    }
    bool interrupt() override { return omega < low || omega > high; }

    HbmOptions options;
    bool only_special;
    double low, high, omega = 0;
    std::unique_ptr<PeriodicEquations> equations;
    double scale;
    PhaseSystem resonant;
    PathParameter parameter;
    vector<std::size_t> crossings;
    vector<double> passed; // the parameter at each point
};

PhaseResonance::PhaseResonance(std::shared_ptr<const ReducedModel> reduced, const BackboneOptions &options,
                               Watch watch)
    : reduced_(std::move(reduced)), options_(options), watch_(watch) {
    options_.hbm.unknowns =
        NonlinearUnknowns::modal; // the phase is a function of all coordinates, not of the gaps
    if (options_.force_max <= 0) options_.force_max = 8 * options_.hbm.force_scale;
}

bool PhaseResonance::correct(double force, BranchPoint &point) const {
    const auto none = new_branch();
    Followed path(*this, point, *none);
    vector<double> y = path.resonant.unknowns(point);
    const NewtonOutcome out = newton_at(path.resonant, newton_limits(options_.hbm), y, force);
    if (!out.converged) return false;
    BranchPoint found = path.resonant.solved_point({y, force}, out.residual, out.iterations);
    if (!(found.omega > 0)) return false;
    point = std::move(found);
    return true;
}

std::shared_ptr<Branch> PhaseResonance::new_branch() const {
    return std::make_shared<Branch>(reduced_, options_.hbm.force_scale, options_.hbm.period_multiple);
}

Backbone PhaseResonance::follow(const BranchPoint &start, bool upward, double low) const {
    const auto branch = new_branch();
    Followed path(*this, start, *branch);
    PathOptions range = path_options(options_.hbm, low, options_.force_max);
    range.upward = upward;
    range.max_step = std::min(longest_step, options_.hbm.max_step);
    range.locate = true;
    PathStart from;
    from.at = {path.resonant.unknowns(start), start.force_scale};
    from.scale = path.scale;
    path.run(range, from);
    if (branch->end_reason == reason::cancelled) require_unstopped(*branch);
    if (branch->end_reason == reason::none) branch->end_reason = reason::range_end;
    branch->unknowns_used = options_.exact ? "state" : "modal";
    return {branch, std::move(path.crossings), static_cast<std::int64_t>(path.passed.size())};
}

StiffnessPath PhaseResonance::over_stiffness(const BranchPoint &peak, double factor) const {
    StiffnessPath found{new_branch(), {}};
    Followed path(*this, peak, *found.branch, PathParameter::stiffness);
    const double end = std::log(factor);
    PathOptions range = path_options(options_.hbm, std::min(0.0, end), std::max(0.0, end));
    range.upward = end > 0;
    PathStart from;
    from.at = {path.resonant.unknowns(peak), 0};
    path.run(range, from);
    for (double p : path.passed) found.factor.push_back(std::exp(p));
    return found;
}

Backbone PhaseResonance::upward_from(const BranchPoint &start) const {
    return follow(start, true, below_the_force * std::min(start.force_scale, options_.hbm.force_scale));
}

Backbone PhaseResonance::onward(const BranchPoint &point) const {
    return follow(point, true, next_to_nothing * point.force_scale);
}

Backbone PhaseResonance::through(const BranchPoint &point) const {
    const Backbone down = follow(point, false, next_to_nothing * point.force_scale), up = upward_from(point);
    Backbone all{joined(*down.branch, *up.branch), {}, down.n_passed + up.n_passed};
    const std::size_t joint = down.branch->points().size() - 1;
    for (std::size_t i : down.crossings)
        if (i > 0) all.crossings.push_back(joint - i);
    std::sort(all.crossings.begin(), all.crossings.end());
    if (point.force_scale == options_.hbm.force_scale) all.crossings.push_back(joint);
    for (std::size_t i : up.crossings) all.crossings.push_back(joint + i);
    return all;
}

// --- where backbones begin

std::vector<Backbone> PhaseResonance::backbones() const {
    std::vector<Backbone> all;
    within(effort_left(), [&] {
        for (BranchPoint start : linear_resonances(reduced_, options_.hbm)) {
            const double omega = start.omega;
            if (!correct(start.force_scale, start) || std::abs(start.omega / omega - 1) > about_resonance)
                continue;
            all.push_back(upward_from(start));
        }
    });
    return all;
}

// Between two points of the curve at which the phase changes its sign, Newton's method from the chord.
std::vector<BranchPoint> PhaseResonance::on_curve(const Branch &curve) const {
    std::vector<BranchPoint> found;
    const auto &points = curve.points();
    const std::int64_t multiple = options_.hbm.period_multiple;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double left = phase_of(*reduced_, points[i - 1], multiple),
                     right = phase_of(*reduced_, points[i], multiple);
        if (!(left * right <= 0) || left == right) continue;
        const double t = left / (left - right);
        BranchPoint p = between(points[i - 1], points[i], t);
        if (!correct(curve.force_scale(), p)) continue;
        found.push_back(std::move(p));
    }
    return found;
}

} // namespace plm
