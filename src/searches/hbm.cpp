#include "searches/hbm.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "linalg/scale.hpp"
#include "linalg/work.hpp"
#include "motions/curve_verdicts.hpp"
#include "motions/effort_budget.hpp"
#include "motions/free_motion.hpp"
#include "motions/motion_measures.hpp"
#include "orbits/orbit_points.hpp"
#include "orbits/stability.hpp"
#include "reduction/widened_model.hpp"
#include "searches/basis_error.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/motion_choice.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>

namespace plm {

Hbm::Hbm(std::shared_ptr<const ReducedModel> reduced, const SweepRange &window, const HbmOptions &options,
         Watch watch)
    : basis_(std::move(reduced)), reduced_(basis_), options_(options), window_(window), watch_(watch) {
    const bool fixed_min = options_.frequency_min_hz > 0, fixed_max = options_.frequency_max_hz > 0;
    if (!fixed_min) options_.frequency_min_hz = window.min_hz;
    if (!fixed_max) options_.frequency_max_hz = window.max_hz;
    reach_ = {options_.frequency_min_hz, options_.frequency_max_hz,
              fixed_min ? options_.frequency_min_hz : window.least_hz,
              fixed_max ? options_.frequency_max_hz : window.most_hz};
    require_consistent(options_);
    exact_ = prefers_exact(*reduced_, options_);
    if (exact_ || prefers_exact_compressed(*reduced_, options_)) {
        const auto wide = widened(reduced_);
        if (exact_ || compresses(*wide, options_)) reduced_ = wide;
    }
}

Hbm::Hbm(std::shared_ptr<const Basis> basis, const HbmOptions &options, Watch watch)
    : Hbm(basis->reduced(), basis->sweep_range(), options, watch) {
    made_as_ = std::move(basis);
}

Hbm::~Hbm() = default;

std::shared_ptr<const ReducedModel> Hbm::model_of(const Branch &branch, const char *argument) const {
    if (of_one_basis(branch.reduced_model(), basis_)) return branch.reduced_model();
    throw Error(status::argument, "the branch belongs to another basis").argument(argument);
}

SweepTask Hbm::task() const {
    return {{reduced_, options_, watch_, exact_}, reach_};
}

std::shared_ptr<const Branch> Hbm::sweep(const Output *asked, LevelBefore *level_before,
                                         std::shared_ptr<const Branch> look) const {
    SweepTask task = this->task();
    task.look = std::move(look);
    task.asked = asked;
    task.level_before = level_before;
    return judged(task);
}

std::shared_ptr<const Branch> Hbm::sweep(CurveRecorder &recorder) const {
    SweepTask task = this->task();
    task.recorder = &recorder;
    return judged(task);
}

std::shared_ptr<const Branch> Hbm::sweep_with_few_harmonics() const {
    return plm::sweep_with_few_harmonics(task());
}

std::shared_ptr<const Branch> Hbm::judged(const SweepTask &task) const {
    const Clock::time_point begin = Clock::now();
    const auto branch = sweep_whole(task);
    check_damping(watch_, *branch);
    judge(*branch, task.level_before);
    branch->seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (task.recorder) task.recorder->finish(*branch);
    return branch;
}

// What is wrong with a finished curve. One that was stopped is delivered at once.
void Hbm::judge(Branch &curve, LevelBefore *before) const {
    if (was_stopped(curve)) return;
    if (!within(effort_left(), [&] { look_over(curve, before); }))
        curve.warnings.add(reason::effort,
                           "the effort allowed was spent before the curve was compared with the "
                           "whole structure; raise the effort of the context");
}

void Hbm::look_over(Branch &curve, LevelBefore *before) const {
    curve.set_multiplier_error(multiplier_error_of(
        made_as_, options_, curve, std::max(EffortBudget::aside, flops_of(curve, options_)), watch_));
    check_window(window_, watch_, curve);
    const auto error = [&] {
        const std::int64_t top = largest_response(curve);
        return basis_error_at(made_as_, options_, curve, top, most_moving(curve, top), EffortBudget::aside,
                              watch_);
    };
    check_basis(window_, error, watch_, curve, before ? &before->judged : nullptr);
    check_switching(watch_, curve);
}

BranchPoint Hbm::first_guess(const Branch &start, std::int64_t point) const {
    const std::int64_t multiple = options_.period_multiple / start.period_multiple();
    if (multiple * start.period_multiple() != options_.period_multiple)
        throw Error(status::argument,
                    format("the start repeats after %lld excitation periods, which period_multiple = %lld is "
                           "not a multiple of",
                           static_cast<long long>(start.period_multiple()),
                           static_cast<long long>(options_.period_multiple)))
            .argument("start");
    return on_longer_period(start.points().at(static_cast<std::size_t>(point)), multiple);
}

std::shared_ptr<const Branch> Hbm::solve(double frequency_hz, const Branch *start, std::int64_t point) const {
    const Clock::time_point begin = Clock::now();
    std::shared_ptr<const Branch> on_basis;
    if (start) start = (on_basis = on_whole_basis(*start, options_, point, point)).get();
    ResponseTask task = this->task();
    if (start && model_of(*start, "start") != reduced_) { // its coordinates are those of that model
        task.reduced = model_of(*start, "start");
        task.exact = exact_ && task.reduced == widened(basis_);
    }
    if (!(frequency_hz >= smallest_scale && frequency_hz <= largest_scale))
        throw Error(status::argument,
                    format("frequency_hz is %g; it must be positive, and squares must neither vanish nor "
                           "overflow (%g to %g)",
                           frequency_hz, smallest_scale, largest_scale))
            .argument("frequency_hz");
    const auto branch =
        std::make_shared<Branch>(task.reduced, options_.force_scale, options_.period_multiple);
    BranchPoint guess, result;
    if (start) guess = first_guess(*start, point);
    if (!solve_at(task, 2 * M_PI * frequency_hz, start ? &guess : nullptr, *branch, result))
        throw Error(status::convergence,
                    format("no periodic response was found at %.6g Hz; give a neighbouring point "
                           "as start or use a sweep%s",
                           frequency_hz, drift_hint(*task.reduced).c_str()))
            .argument("frequency_hz")
            .reason(reason::start_failed);
    Stability stability(task.reduced, options_, StabilityOf::point);
    if (stability.wanted() && !result.motion) result.multipliers = stability.multipliers(result);
    if (stability.wanted() && result.multipliers.empty())
        branch->warnings.add(reason::unverified, stability.unknown_text(1, 1));
    branch->append(std::move(result));
    warn_of_harmonics(with_affordable_harmonics(*task.reduced, options_), *branch);
    branch->end_reason = reason::range_end;
    branch->unknowns_used = branch->points()[0].motion               ? "state"
                            : prefers_modal(*task.reduced, options_) ? "modal"
                                                                     : "gaps";
    check_window(window_, watch_, *branch);
    finish(watch_, begin, *branch);
    return branch;
}

} // namespace plm
