#include "searches/fold_tracking.hpp"
#include "hbm/harmonic_folds.hpp"
#include "motions/branch_path.hpp"
#include "motions/periodic_equations.hpp"
#include "orbits/orbit_folds.hpp"

namespace plm {
namespace {

// Of exact motions where `about` is one.
std::unique_ptr<PeriodicEquations> fold_equations(std::shared_ptr<const ReducedModel> reduced,
                                                  const HbmOptions &options, const BranchPoint &about) {
    if (about.motion) return std::make_unique<OrbitFolds>(std::move(reduced), options, about);
    return std::make_unique<HarmonicFolds>(std::move(reduced), options, about);
}

constexpr double not_near = 0.1; // damping of a correction

class FoldPath final : public PathOwner {
  public:
    FoldPath(std::shared_ptr<const ReducedModel> reduced, const FoldOptions &options,
             const BranchPoint &about, Watch watch)
        : options_(options), watch_(watch), exact_(about.motion != nullptr),
          equations_(fold_equations(reduced, options.hbm, about)),
          branch_(std::make_shared<Branch>(reduced, options.hbm.force_scale, options.hbm.period_multiple)) {}

    bool correct(double force, BranchPoint &point) {
        PathState at = {equations_->unknowns(point), force};
        NewtonLimits limits = newton_limits(options_.hbm);
        limits.min_damping = not_near; // a guess is good, or leads elsewhere
        const NewtonOutcome out = newton_at(equations_->residual(), limits, at.x, force);
        if (!out.converged) return false;
        BranchPoint found = equations_->solved_point(at, out.residual, out.iterations);
        if (!(found.omega > 0)) return false;
        point = std::move(found);
        return true;
    }

    std::shared_ptr<Branch> follow(const BranchPoint &start) {
        PathOptions range = path_options(options_.hbm, options_.force_min, options_.force_max);
        range.upward = options_.upward;
        constexpr double first = 0.05; // an extremum may be close
        range.initial_step = first * range.max_step;
        range.locate = true;
        PathStart from;
        from.at = {equations_->unknowns(start), start.force_scale};
        from.residual = start.residual;
        take_outcome(follow_path(equations_->residual(), range, from, *this), *branch_);
        branch_->unknowns_used = exact_ ? "state" : "modal";
        return branch_;
    }

    void record(const PathPoint &p) override {
        turned_ = turned_ || p.bifurcation == PLM_BIFURCATION_FOLD;
        BranchPoint point = equations_->solved_point({p.x, p.parameter}, p.residual, p.iterations);
        put_place(p, point);
        branch_->append(std::move(point));
    }
    bool cancelled(double fraction) override {
        watch_.step("folds", fraction);
        return false;
    }
    bool rescue(double, vector<double> &) override { return false; }
    bool interrupt() override { return options_.stop_at_turn && turned_; }

  private:
    FoldOptions options_;
    Watch watch_;
    bool exact_;
    std::unique_ptr<PeriodicEquations> equations_;
    std::shared_ptr<Branch> branch_;
    bool turned_ = false;
};

} // namespace

bool correct_fold(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, double force,
                  const BranchPoint &near, BranchPoint &point) {
    FoldOptions o;
    o.hbm = options;
    return FoldPath(std::move(reduced), o, near, Watch()).correct(force, point);
}

std::shared_ptr<Branch> follow_folds(std::shared_ptr<const ReducedModel> reduced, const FoldOptions &options,
                                     const BranchPoint &fold, Watch watch) {
    FoldPath path(std::move(reduced), options, fold, watch);
    BranchPoint start = fold;
    if (!path.correct(fold.force_scale, start)) return nullptr;
    return path.follow(start);
}

namespace {

bool ends_well(const Branch &b) {
    return b.end_reason == PLM_REASON_RANGE_END || b.end_reason == PLM_REASON_LOOP_CLOSED;
}

} // namespace

std::shared_ptr<Branch> follow_folds_both_ways(std::shared_ptr<const ReducedModel> reduced,
                                               FoldOptions options, const BranchPoint &fold, Watch watch) {
    options.upward = false;
    const auto below = follow_folds(reduced, options, fold, watch);
    if (!below || below->end_reason == PLM_REASON_LOOP_CLOSED) return below;
    const std::int64_t used = static_cast<std::int64_t>(below->points().size());
    options.upward = true;
    options.hbm.max_points = std::max<std::int64_t>(1, options.hbm.max_points - used + 1);
    const auto above = follow_folds(std::move(reduced), options, fold, watch);
    if (!above) return below;
    const auto whole = joined(*below, *above);
    if (!ends_well(*below)) whole->end_reason = below->end_reason;
    return whole;
}

} // namespace plm
