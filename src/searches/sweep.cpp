#include "searches/sweep.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/harmonic_point.hpp"
#include "linalg/work.hpp"
#include "motions/curve_verdicts.hpp"
#include "motions/effort_budget.hpp"
#include "motions/error_budget.hpp"
#include "motions/first_harmonics.hpp"
#include "motions/free_motion.hpp"
#include "orbits/mean_motion.hpp"
#include "orbits/orbit_cost.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/curve.hpp"
#include "searches/wider_range.hpp"
#include <algorithm>
#include <cmath>
#include <exception>

namespace plm {
namespace {

// A curve that could not be followed, not one that is long or was stopped.
bool is_stuck(const Branch &branch) {
    return branch.end_reason == reason::step_minimum || branch.end_reason == reason::contact_chatter ||
           branch.end_reason == reason::singular_tangent;
}

std::shared_ptr<Branch> new_branch(const ResponseTask &task) {
    return std::make_shared<Branch>(task.reduced, task.options.force_scale, task.options.period_multiple);
}

// The curve of harmonic balance where that of exact motions could not be followed to its end; null: none
// begins at omega, or most of its points need not be near any motion.
std::shared_ptr<Branch> by_harmonics(const SweepTask &task, double omega) {
    auto branch = new_branch(task);
    CurveStart start;
    if (!solve_by_harmonics(task.reduced, task.options, omega, nullptr, task.watch, task.only_looks, *branch,
                            start.point))
        return nullptr;
    trace_curve(task.options, start, task.watch, *branch, task.recorder);
    return is_worthless(*branch) ? nullptr : branch;
}

std::shared_ptr<Branch> follow_curve(const SweepTask &task) {
    const auto begin = std::chrono::steady_clock::now();
    auto branch = new_branch(task);
    const double low = 2 * M_PI * task.options.frequency_min_hz,
                 high = 2 * M_PI * task.options.frequency_max_hz;
    const double from = task.options.upward ? low : high,
                 into = task.options.upward ? high - low : low - high;
    // A start inside a super-harmonic region may fail, or find no exact motion, or no solution that more
    // harmonics confirm: the range is entered a little further on then, if that is better.
    CurveStart start;
    bool found = false;
    const bool dear = !affords_paths(*task.reduced, with_first_harmonics(*task.reduced, task.options));
    constexpr int most_attempts = 5;
    constexpr double further_in = 0.02; // of the range: what is left out of the curve is to be small
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        task.watch.step("sweep", 0.0);
        BranchPoint point;
        if (!solve_at(task, from + further_in * attempt * into, nullptr, *branch, point)) continue;
        if (!found || point.harmonic_error < start.point.harmonic_error) start.point = point;
        found = true;
        // an exact motion has all harmonics, whatever its coefficients leave out
        const double enough = task.exact ? task.options.allowed_harmonic_error() : worthless_error;
        if (task.options.n_harmonics != 0 || start.point.motion || start.point.harmonic_error < enough ||
            dear)
            break;
    }
    if (!found)
        throw Error(
            status::convergence,
            format("no periodic response was found at the start of the sweep (%.6g Hz and four neighbours), "
                   "nor at its other end; sweep over another range (frequency_min_hz, frequency_max_hz) or "
                   "with a smaller force_scale%s",
                   from / (2 * M_PI), drift_hint(*task.reduced).c_str()))
            .reason(reason::start_failed);
    if (task.level_before) start.beside = task.level_before->curve;
    trace_curve(task.options, start, task.watch, *branch, task.recorder);
    if (task.exact && task.options.motion == MotionKind::automatic && is_stuck(*branch)) {
        const auto other = by_harmonics(task, start.point.omega);
        if (other && !is_stuck(*other)) {
            other->newton_work += branch->newton_work;
            other->failed_steps += branch->failed_steps;
            branch = other;
        }
    }
    if (!was_stopped(*branch))
        bring_peak_inside(task.options, task.reach, task.asked, task.watch, *branch, task.recorder);
    finish(task.watch, begin, *branch);
    return branch;
}

// Where the first look had to go beyond the range for its peak, so has the curve, and better from its
// beginning: what effort there is then goes to the peak first.
void take_range(const Branch &look, HbmOptions &options) {
    for (const BranchPoint &end : {look.points().front(), look.points().back()}) {
        const double hz = end.omega / (2 * M_PI);
        options.frequency_min_hz = std::min(options.frequency_min_hz, hz);
        options.frequency_max_hz = std::max(options.frequency_max_hz, hz);
    }
}

// The model that the curve of another level was followed on, or one by a first look at this one. False: the
// latter would not be much smaller than the basis.
bool begin_compression(SweepTask &task, std::shared_ptr<CurveCompression> &compression) {
    if (task.level_before && task.level_before->compression) {
        compression = std::move(task.level_before->compression);
        compression->go_on(task.options, *task.level_before->curve);
        task.options = compression->options();
        return true;
    }
    compression = std::make_shared<CurveCompression>(task.reduced, task.options,
                                                     2 * M_PI * task.options.frequency_max_hz, task.watch);
    if (!task.look) {
        SweepTask look = task;
        look.watch = task.watch.quiet();
        const auto first = sweep_with_few_harmonics(look);
        if (first->end_reason == reason::cancelled) require_unstopped(*first);
        task.look = first;
    }
    take_range(*task.look, task.options);
    return compression->begin_with(*task.look);
}

struct CompressedCurve {
    std::shared_ptr<Branch> curve; // null: none came to its end
    bool holds = false;            // false: the whole basis says otherwise, or was not to be asked
};

// The curve on a model that has what its motions need of the basis; none where such a model would not be much
// smaller.
CompressedCurve sweep_compressed(const SweepTask &task) {
    constexpr int most_curves = 3;
    std::shared_ptr<CurveCompression> kept;
    SweepTask curve = task;
    CompressedCurve last; // the one that came to its end: there is none better where the effort ends
    try {
        if (!begin_compression(curve, kept)) return last;
        const HbmOptions options = curve.options;
        CurveCompression &compression = *kept;
        for (int k = 0; k < most_curves; ++k) {
            curve.reduced = compression.model();
            curve.options = options_on(*curve.reduced, options);
            curve.exact = true;
            const auto branch = follow_curve(curve);
            if (branch->end_reason == reason::cancelled || (!last.curve && was_stopped(*branch)))
                return {branch, true};
            require_unstopped(*branch);
            if (is_stuck(*branch)) break;
            last.curve = branch;
            if (task.level_before) task.level_before->curve = branch;
            const bool confirmed = compression.confirms(*branch);
            if (std::isfinite(compression.error())) branch->model_error = compression.error();
            if (!confirmed && !compression.is_spent()) {
                if (compression.model() == curve.reduced) break; // its highest motion is not exact
                continue;
            }
            if (!compression.confirms_stability(*branch) && k + 1 < most_curves) continue;
            last.holds = true;
            if (task.level_before) task.level_before->compression = kept;
            break;
        }
    } catch (const Error &e) {
        if (e.status() == status::memory || e.status() == status::callback) throw;
        if (e.status() == status::cancelled) {
            if (!last.curve) throw;
            if (e.reason() != reason::effort) last.curve->end_reason = e.reason();
            last.holds = true;
        }
    }
    if (last.curve) kept->warn(*last.curve);
    return last;
}

// The curve on the basis itself; the one on less of it where that does not come to its end, or would take
// more than the effort allowed.
std::shared_ptr<Branch> follow_beside(const SweepTask &task, const std::shared_ptr<Branch> &compressed) {
    const double steps = static_cast<double>(compressed->newton_work.iterations);
    if (steps * exact_step_flops(*task.reduced, task.options) > effort_left()) return compressed;
    try {
        const auto branch = follow_curve(task);
        if (spans(*branch)) return branch;
        if (branch->end_reason == reason::cancelled) compressed->end_reason = reason::cancelled;
    } catch (const Error &e) {
        if (e.status() == status::memory || e.status() == status::callback) throw;
        if (e.status() == status::cancelled && e.reason() != reason::effort)
            compressed->end_reason = e.reason();
    }
    return compressed;
}

std::shared_ptr<Branch> sweep_from_its_end(const SweepTask &task) {
    CompressedCurve compressed;
    if (compresses(*task.reduced, task.options)) compressed = sweep_compressed(task);
    const auto branch = compressed.holds   ? compressed.curve
                        : compressed.curve ? follow_beside(task, compressed.curve)
                                           : follow_curve(task);
    check_span(task.options.upward, task.watch, *branch);
    return branch;
}

void take_other_way(const SweepTask &task, std::shared_ptr<Branch> &branch) {
    SweepTask back = task;
    back.options.upward = !task.options.upward;
    task.watch.log(1, format("no whole curve from the %s end; from the other one",
                             task.options.upward ? "lower" : "upper"));
    try {
        const auto other = sweep_from_its_end(back);
        const bool is_better = spans(*other) || other->end_reason == reason::point_limit;
        if (branch && was_stopped(*other)) branch->end_reason = other->end_reason;
        if (branch && !is_better) return;
        if (branch && branch->end_reason == reason::loop_closed) other->beside = branch;
        branch = other;
    } catch (const Error &e) { // what the first way found, or why it found nothing, stays
        if (e.status() == status::memory || e.status() == status::callback) throw;
        if (e.status() != status::cancelled) return;
        if (!branch) throw;
        branch->end_reason = e.reason();
    }
}

// What comes back, is stuck or finds no first motion from one end may be a whole curve from the other.
std::shared_ptr<Branch> sweep_either_way(const SweepTask &task) {
    std::shared_ptr<Branch> branch;
    std::exception_ptr no_start;
    try {
        branch = sweep_from_its_end(task);
    } catch (const Error &e) {
        if (e.reason() != reason::start_failed) throw;
        no_start = std::current_exception();
    }
    if (!branch || (!spans(*branch) && branch->end_reason != reason::point_limit && !was_stopped(*branch)))
        take_other_way(task, branch);
    if (!branch) std::rethrow_exception(no_start);
    return branch;
}

// As few harmonics as show the curve, then as many as its points need: the last one that there is effort for.
void take_harmonics(const SweepTask &task, std::shared_ptr<Branch> &branch) {
    const std::shared_ptr<const Branch> part = branch;
    task.watch.log(1, "exact motions would take more than the effort allowed: the curve by harmonic balance");
    SweepTask other = task;
    other.exact = false;
    other.options.motion = MotionKind::harmonics;
    const auto take = [&](const std::shared_ptr<Branch> &next) {
        if (branch && (was_stopped(*next) || (spans(*branch) && !spans(*next)))) return;
        if (!branch || !part || says_more(*next, *part, task.watch)) branch = next;
    };
    within(effort_left(),
           [&] { take(task.look ? std::make_shared<Branch>(*task.look) : sweep_with_few_harmonics(other)); });
    within(effort_left(), [&] { take(sweep_either_way(other)); });
}

} // namespace

std::shared_ptr<Branch> sweep_with_few_harmonics(const SweepTask &task) {
    constexpr std::int64_t few_points = 250;
    SweepTask look = task;
    look.exact = false;
    look.only_looks = true;  // at the peak, if it is the answer, it is measured
    look.recorder = nullptr; // made again in seconds
    look.level_before = nullptr;
    look.options.motion = MotionKind::harmonics;
    look.options.tolerance = std::max(task.options.tolerance, ErrorBudget(task.options.accuracy).look());
    look.options.max_points = std::min(few_points, task.options.max_points);
    look.options.stability = StabilityKind::off;
    look.options.bifurcations = false;
    const std::int64_t fewest = highest_excitation(*task.reduced);
    std::shared_ptr<Branch> curve;
    for (std::int64_t h = harmonics_of_look(*task.reduced);; h = std::max(fewest, h / 2)) {
        look.options.n_harmonics = std::min(h, task.options.max_harmonics);
        const auto sweep = [&] {
            try {
                curve = sweep_either_way(look);
            } catch (const Error &e) {
                if (e.reason() != reason::start_failed || (h == fewest && !curve)) throw;
            }
        };
        if (h == fewest)
            sweep();
        else
            within(EffortBudget::first_curve, sweep);
        if (h == fewest || (curve && (spans(*curve) || curve->end_reason == reason::cancelled))) break;
    }
    const bool is_own_limit = look.options.max_points < task.options.max_points;
    if (curve->end_reason == reason::point_limit && is_own_limit) curve->end_reason = reason::effort;
    return curve;
}

std::shared_ptr<Branch> sweep_whole(const SweepTask &task) {
    std::shared_ptr<Branch> branch;
    const bool has_other = (task.exact && task.options.motion == MotionKind::automatic) ||
                           compresses(*task.reduced, task.options);
    within((has_other ? EffortBudget::exact_first : 1) * effort_left(),
           [&] { branch = sweep_either_way(task); });
    if (has_other && (!branch || branch->end_reason == reason::effort)) take_harmonics(task, branch);
    if (!branch)
        throw Error(status::cancelled,
                    "no periodic response was found with the effort allowed; raise the effort "
                    "of the context, or sweep over a smaller range")
            .reason(reason::effort);
    if (task.level_before) task.level_before->curve = branch;
    return branch;
}

void finish(Watch watch, std::chrono::steady_clock::time_point begin, Branch &branch) {
    branch.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    watch.log(1, format("%zu points, %lld Newton iterations, %lld factorizations, %lld failed steps, %.3g s",
                        branch.points().size(), static_cast<long long>(branch.newton_work.iterations),
                        static_cast<long long>(branch.newton_work.factorizations),
                        static_cast<long long>(branch.failed_steps), branch.seconds));
}

} // namespace plm
