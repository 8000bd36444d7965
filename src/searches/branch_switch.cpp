// From a located branch point or period doubling to the curve that crosses or leaves there: the tangent has a
// null vector that does not belong to the curve at hand; a small step along it, corrected across it, is a
// first point of the other one.
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "linalg/scale.hpp"
#include "motions/branch_path.hpp"
#include "orbits/orbit_points.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/curve.hpp"
#include "searches/hbm.hpp"
#include "searches/point_equations.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// First steps on the other curve, of the size of the motion: long enough to be clear of the curve at hand,
// short enough for the curve to begin like its null vector.
constexpr double first_steps[] = {1e-2, 3e-2, 1e-1, 3e-3, 1e-3};
constexpr double further_on = 1.5; // of that step: a second point, which gives the direction
// A corrected point farther off, of the step or of the range of frequencies, is another solution.
constexpr double far_away = 10, far_in_frequency = 0.2;

vector<double> null_vector(Residual &system, const vector<double> &x, double omega) {
    vector<double> r(system.size());
    system.residual(x.data(), omega, r.data());
    system.linearize();
    const vector<double> v = null_direction(system);
    if (!all_finite(v.data(), system.size()))
        throw Error(status::convergence, "the tangent's null vector was not found at this point")
            .reason(reason::singular_tangent);
    return v;
}

class Switch {
  public:
    Switch(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, const BranchPoint &origin,
           const BranchPoint &along, bool mirrored)
        : options_(options), mirrored_(mirrored) {
        options_.n_harmonics = harmonics_of(origin, options.period_multiple);
        options_.unknowns =
            prefers_modal(*reduced, options) ? NonlinearUnknowns::modal : NonlinearUnknowns::gaps;
        equations_ = equations_of(std::move(reduced), options_, origin);
        at_ = {equations_->unknowns(origin), origin.omega};
        const double size = size_of(*equations_, at_.x);
        metric_ = {size > 0 ? size : 1, 2 * M_PI * (options.frequency_max_hz - options.frequency_min_hz)};
        set_direction(along);
    }

    // A first point of the other curve and one a little further on.
    bool find(CurveStart &start) {
        for (double step : first_steps) {
            if (!corrected(step, start.point)) continue;
            BranchPoint further;
            if (!corrected(further_on * step, further)) continue;
            start.towards = {further};
            return true;
        }
        return false;
    }

    const NewtonWork &work() const { return work_; }

  private:
    // The null vector less its share of the curve at hand, of length 1.
    void set_direction(const BranchPoint &along) {
        direction_ = {null_vector(*equations_, at_.x, at_.parameter), 0};
        const PathState tangent = difference({equations_->unknowns(along), along.omega}, at_);
        const double square = metric_.product(tangent, tangent);
        if (square > 0) add(-metric_.product(tangent, direction_) / square, tangent, direction_);
        scale_by((mirrored_ ? -1 : 1) / metric_.length(direction_), direction_);
    }

    bool corrected(double step, BranchPoint &point) {
        PathState to = at_;
        add(step, direction_, to);
        NewtonLimits limits = newton_limits(options_);
        limits.min_damping = 1e-2; // a guess that needs more is none: the next step is tried
        const NewtonOutcome out = newton_across(*equations_, metric_, direction_, limits, to);
        work_ += out;
        const PathState moved = difference(to, at_);
        if (!out.converged || std::abs(moved.parameter) > far_in_frequency * metric_.width) return false;
        if (metric_.length({moved.x, 0}) > far_away * step) return false;
        point = equations_->solved_point(to, out.residual, out.iterations);
        return true;
    }

    HbmOptions options_;
    bool mirrored_;
    std::unique_ptr<PeriodicEquations> equations_;
    Metric metric_;
    PathState at_, direction_;
    NewtonWork work_;
};

} // namespace

std::shared_ptr<const Branch> Hbm::switch_branch(const Branch &given, std::int64_t point,
                                                 bool mirrored) const {
    const Clock::time_point begin = Clock::now();
    const auto on_basis = on_whole_basis(given, options_, point - 1, point + 1);
    const Branch &branch = *on_basis;
    const std::shared_ptr<const ReducedModel> reduced = model_of(branch, "branch");
    const BranchPoint &origin = branch.points().at(static_cast<std::size_t>(point));
    if (origin.bifurcation != bifurcation::branch_point && origin.bifurcation != bifurcation::period_doubling)
        throw Error(status::argument,
                    format("point %lld is neither a branch point nor a period doubling; see the "
                           "branch's \"bifurcation\"",
                           static_cast<long long>(point)))
            .argument("point")
            .index(point);
    const std::int64_t factor = origin.bifurcation == bifurcation::period_doubling ? 2 : 1;
    HbmOptions options = options_;
    options.period_multiple = factor * branch.period_multiple();
    options.force_scale = origin.force_scale;
    const std::size_t neighbour = static_cast<std::size_t>(point > 0 ? point - 1 : point + 1);
    const BranchPoint &along = branch.points().size() > 1 ? branch.points()[neighbour] : origin;
    const auto longer = [&](const BranchPoint &p) { return p.motion ? p : on_longer_period(p, factor); };
    Switch other(reduced, options, longer(origin), longer(along), mirrored);
    CurveStart start;
    if (!other.find(start))
        throw Error(status::convergence, "no point of another curve was found beside this one")
            .argument("point")
            .reason(reason::start_failed);
    auto found = std::make_shared<Branch>(reduced, options.force_scale, options.period_multiple);
    found->newton_work = other.work();
    trace_curve(options, start, watch_, *found);
    finish(watch_, begin, *found);
    return found;
}

} // namespace plm
