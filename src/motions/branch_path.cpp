#include "motions/branch_path.hpp"

namespace plm {

NewtonLimits newton_limits(const MotionOptions &options) {
    NewtonLimits limits;
    limits.tolerance = options.tolerance;
    limits.max_iterations = options.max_iterations;
    return limits;
}

PathOptions path_options(const MotionOptions &options, double low, double high) {
    PathOptions p;
    p.low = low;
    p.high = high;
    p.tolerance = options.tolerance;
    p.max_iterations = options.max_iterations;
    p.max_points = options.max_points;
    p.min_step = options.min_step;
    p.max_step = options.max_step;
    p.scale_falls = options.period_multiple > 1;
    return p;
}

void put_record(double residual, std::int64_t iterations, std::int64_t n_switching, BranchPoint &point) {
    point.residual = residual;
    point.iterations = iterations;
    point.n_switching = n_switching;
}

void put_place(const PathPoint &at, BranchPoint &point) {
    point.arclength = at.arclength;
    point.bifurcation = at.bifurcation;
}

void take_outcome(const PathOutcome &outcome, Branch &branch) {
    branch.end_reason = outcome.end_reason;
    branch.newton_work += outcome.work;
    branch.failed_steps += outcome.failed_now;
}

std::shared_ptr<Branch> joined(const Branch &before, const Branch &after) {
    auto whole =
        std::make_shared<Branch>(after.reduced_model(), after.force_scale(), after.period_multiple());
    const double length = before.points().back().arclength;
    for (auto p = before.points().rbegin(); p != before.points().rend() - 1; ++p) {
        BranchPoint point = *p;
        point.arclength = length - point.arclength;
        whole->append(std::move(point));
    }
    for (BranchPoint point : after.points()) {
        point.arclength += length;
        whole->append(std::move(point));
    }
    whole->end_reason = after.end_reason;
    whole->newton_work = before.newton_work;
    whole->newton_work += after.newton_work;
    whole->failed_steps = before.failed_steps + after.failed_steps;
    whole->unknowns_used = before.unknowns_used == after.unknowns_used ? after.unknowns_used : "both";
    whole->sampled = after.sampled;
    return whole;
}

} // namespace plm
