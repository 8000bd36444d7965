#include "searches/fold_tracking.hpp"
#include "hbm/harmonic_choice.hpp"
#include "motions/fold_system.hpp"
#include "motions/tracer.hpp"
#include "searches/point_equations.hpp"

namespace plm {
namespace {

// What stands beside the tangent of harmonic balance needs reduced coordinates and events.
std::unique_ptr<PeriodicEquations> equations_beside(std::shared_ptr<const ReducedModel> reduced,
                                                    HbmOptions options, const BranchPoint &about) {
    options.unknowns = NonlinearUnknowns::modal;
    options.aft = AftKind::event;
    options.n_harmonics = harmonics_of(about, options.period_multiple);
    return make_equations(std::move(reduced), options, kind_of(about), about.omega);
}

constexpr double not_near = 0.1; // damping of a correction

class FoldPath final : public Tracer {
  public:
    FoldPath(const FoldOptions &options, const BranchPoint &about, Watch watch, Branch &branch)
        : Tracer("folds", watch, branch), options_(options),
          equations_(equations_beside(branch.reduced_model(), options.hbm, about)),
          folds_(*equations_, about) {
        branch.unknowns_used = about.motion ? "state" : "modal";
    }

    bool correct(double force, BranchPoint &point) {
        PathState at = {folds_.unknowns(point), force};
        NewtonLimits limits = newton_limits(options_.hbm);
        limits.min_damping = not_near; // a guess is good, or leads elsewhere
        const NewtonOutcome out = newton_at(folds_, limits, at.x, force);
        if (!out.converged) return false;
        BranchPoint found = folds_.solved_point(at, out.residual, out.iterations);
        if (!(found.omega > 0)) return false;
        point = std::move(found);
        return true;
    }

    void follow_from(const BranchPoint &start) {
        PathOptions range = path_options(options_.hbm, options_.force_min, options_.force_max);
        range.upward = options_.upward;
        constexpr double first = 0.05; // an extremum may be close
        range.initial_step = first * range.max_step;
        range.locate = true;
        PathStart from;
        from.at = {folds_.unknowns(start), start.force_scale};
        from.residual = start.residual;
        follow(folds_, range, from);
    }

    void record(const PathPoint &p) override {
        turned_ = turned_ || p.bifurcation == bifurcation::fold;
        BranchPoint point = folds_.solved_point({p.x, p.parameter}, p.residual, p.iterations);
        put_place(p, point);
        branch_.append(std::move(point));
    }
    bool interrupt() override { return options_.stop_at_turn && turned_; }

  private:
    FoldOptions options_;
    std::unique_ptr<PeriodicEquations> equations_;
    FoldSystem folds_;
    bool turned_ = false;
};

std::shared_ptr<Branch> new_branch(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options) {
    return std::make_shared<Branch>(std::move(reduced), options.force_scale, options.period_multiple);
}

} // namespace

bool correct_fold(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, double force,
                  const BranchPoint &near, BranchPoint &point) {
    FoldOptions o;
    o.hbm = options;
    return FoldPath(o, near, Watch(), *new_branch(std::move(reduced), options)).correct(force, point);
}

std::shared_ptr<Branch> follow_folds(std::shared_ptr<const ReducedModel> reduced, const FoldOptions &options,
                                     const BranchPoint &fold, Watch watch) {
    const auto branch = new_branch(std::move(reduced), options.hbm);
    FoldPath path(options, fold, watch, *branch);
    BranchPoint start = fold;
    if (!path.correct(fold.force_scale, start)) return nullptr;
    path.follow_from(start);
    return branch;
}

namespace {

bool ends_well(const Branch &b) {
    return b.end_reason == reason::range_end || b.end_reason == reason::loop_closed;
}

} // namespace

std::shared_ptr<Branch> follow_folds_both_ways(std::shared_ptr<const ReducedModel> reduced,
                                               FoldOptions options, const BranchPoint &fold, Watch watch) {
    options.upward = false;
    const auto below = follow_folds(reduced, options, fold, watch);
    if (!below || below->end_reason == reason::loop_closed || was_stopped(*below)) return below;
    const std::int64_t used = static_cast<std::int64_t>(below->points().size());
    options.upward = true;
    options.hbm.max_points = std::max<std::int64_t>(1, options.hbm.max_points - used + 1);
    const auto above = follow_folds(std::move(reduced), options, fold, watch);
    if (!above) return below;
    const auto whole = joined(*below, *above);
    if (!ends_well(*below) && !was_stopped(*above)) whole->end_reason = below->end_reason;
    return whole;
}

} // namespace plm
