#include "searches/hbm.hpp"
#include "hbm/branch_path.hpp"
#include "hbm/free_motion.hpp"
#include "hbm/make_system.hpp"
#include "linalg/scale.hpp"
#include "linalg/work.hpp"
#include "reduction/widened_model.hpp"
#include "searches/basis_error.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/curve.hpp"
#include "searches/curve_verdicts.hpp"
#include "searches/follow.hpp"
#include "searches/harmonic_choice.hpp"
#include "searches/orbit_points.hpp"
#include "searches/stability.hpp"
#include "searches/start.hpp"
#include "searches/wider_range.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>

namespace plm {
namespace {

// What the options ask of one another; the bounds of each stand in the table of the keys.
void check(const HbmOptions &o) {
    const auto refuse = [](const char *name, const std::string &text) {
        throw Error(PLM_ERR_ARGUMENT, text).argument(name);
    };
    if (o.unknowns == NonlinearUnknowns::modal && o.formulation == FormulationKind::compliance)
        refuse("formulation",
               "the compliance formulation has the contact gaps as unknowns; set unknowns to gaps or auto");
    if (!(o.frequency_min_hz > 0 && o.frequency_max_hz > o.frequency_min_hz))
        refuse("frequency_min_hz",
               format("the frequency range [%g, %g] Hz is empty or not positive; set "
                      "frequency_min_hz < frequency_max_hz, or use a basis that has a window",
                      o.frequency_min_hz, o.frequency_max_hz));
    if (!(o.max_step > o.min_step)) refuse("min_step", "min_step must be below max_step");
}

// A curve that could not be followed, not one that is long or was stopped.
bool is_stuck(const Branch &branch) {
    return branch.end_reason == PLM_REASON_STEP_MINIMUM || branch.end_reason == PLM_REASON_CONTACT_CHATTER ||
           branch.end_reason == PLM_REASON_SINGULAR_TANGENT;
}

} // namespace

Hbm::Hbm(std::shared_ptr<const ReducedModel> reduced, const SweepRange &window, const HbmOptions &options,
         Watch watch)
    : basis_(std::move(reduced)), reduced_(basis_), options_(options), window_(window), watch_(watch) {
    const bool fixed_min = options_.frequency_min_hz > 0, fixed_max = options_.frequency_max_hz > 0;
    if (!fixed_min) options_.frequency_min_hz = window.min_hz;
    if (!fixed_max) options_.frequency_max_hz = window.max_hz;
    reach_ = {options_.frequency_min_hz, options_.frequency_max_hz,
              fixed_min ? options_.frequency_min_hz : window.least_hz,
              fixed_max ? options_.frequency_max_hz : window.most_hz};
    check(options_);
    exact_ = prefers_exact(reduced_, options_);
    if (exact_) reduced_ = widened(reduced_);
}

Hbm::Hbm(std::shared_ptr<const Basis> basis, const HbmOptions &options, Watch watch)
    : Hbm(basis->reduced(), basis->sweep_range(), options, watch) {
    made_as_ = std::move(basis);
}

Hbm::~Hbm() = default;

std::shared_ptr<const ReducedModel> Hbm::model_of(const Branch &branch, const char *argument) const {
    if (of_one_basis(branch.reduced_model(), basis_)) return branch.reduced_model();
    throw Error(PLM_ERR_ARGUMENT, "the branch belongs to another basis").argument(argument);
}

std::shared_ptr<Branch> Hbm::new_branch() const {
    return std::make_shared<Branch>(reduced_, options_.force_scale, options_.period_multiple);
}

void Hbm::finish(Branch &branch, Clock::time_point begin) const {
    branch.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    watch_.log(1, format("%zu points, %lld Newton iterations, %lld factorizations, %lld failed steps, %.3g s",
                         branch.points().size(), static_cast<long long>(branch.newton_work.iterations),
                         static_cast<long long>(branch.newton_work.factorizations),
                         static_cast<long long>(branch.failed_steps), branch.seconds));
}

bool Hbm::solve_with(const HbmOptions &options, double omega, const BranchPoint *guess, StartPaths paths,
                     Branch &branch, BranchPoint &point) const {
    const auto system = make_system(reduced_, options);
    vector<double> x(system->size(), 0.0);
    StartOutcome out;
    if (guess) {
        x = unknowns_of(*system, *guess);
        out = follow_to(*system, options, guess->omega, omega, watch_, x);
    }
    if (!out.converged) {
        const vector<double> guessed = x;
        out.add(find_start(*system, *reduced_, options, omega, guess != nullptr, watch_, x, paths));
        if (guess && out.converged) warn_of_other_branch(*system, guessed, x, *guess, omega, branch);
    }
    branch.newton_work += out;
    if (!out.converged) return false;
    point = solved_point(*system, {x, omega}, out.residual, out.iterations);
    return true;
}

bool Hbm::solve_at(double omega, const BranchPoint *guess, Branch &branch, BranchPoint &point) const {
    if (exact_ && solve_exactly_at(omega, guess, branch, point)) return true;
    if (!solve_by_harmonics_at(omega, guess, branch, point)) return false;
    if (exact_ && !make_exact(reduced_, options_, watch_, point, branch.newton_work))
        return options_.motion != MotionKind::exact;
    return true;
}

// Along the exact motions from the guess, or beside a solution with few harmonics.
bool Hbm::solve_exactly_at(double omega, const BranchPoint *guess, Branch &branch, BranchPoint &point) const {
    if (guess && guess->motion)
        return follow_exactly_to(reduced_, options_, *guess, omega, watch_, point, branch.newton_work);
    HbmOptions few = options_;
    few.n_harmonics = few_harmonics(*reduced_);
    if (guess) few.n_harmonics = std::max(few.n_harmonics, harmonics_of(*guess, options_.period_multiple));
    return solve_from_few(few, omega, guess, branch, point) &&
           make_exact(reduced_, options_, watch_, point, branch.newton_work);
}

bool Hbm::solve_by_harmonics_at(double omega, const BranchPoint *guess, Branch &branch,
                                BranchPoint &point) const {
    const HbmOptions options = with_affordable_harmonics(*reduced_, options_);
    HbmOptions wanted = with_first_harmonics(*reduced_, options);
    if (guess && options.n_harmonics == 0) // a start with its harmonics cut would be another motion
        wanted.n_harmonics =
            std::min(options.max_harmonics,
                     std::max(wanted.n_harmonics, harmonics_of(*guess, options.period_multiple)));
    HbmOptions few = options;
    few.n_harmonics = std::min(wanted.n_harmonics, few_harmonics(*reduced_));
    const bool climbs = !guess && wanted.n_harmonics > 2 * few.n_harmonics;
    bool found = climbs && solve_from_few(few, omega, nullptr, branch, point) &&
                 climb_harmonics(reduced_, options, wanted.n_harmonics, point, watch_);
    found = found || solve_from_few(wanted, omega, guess, branch, point);
    if (found && !only_looks_) settle_harmonics(reduced_, options, point, watch_);
    return found;
}

// With the harmonics of `wanted` or, where they are chosen and have no solution that is found, with as many
// as lead to one: the more pairs, the fewer of the ways to a first solution can be gone with all of them.
bool Hbm::solve_from_few(const HbmOptions &wanted, double omega, const BranchPoint *guess, Branch &branch,
                         BranchPoint &point) const {
    if (solve_with(wanted, omega, guess, StartPaths::affordable, branch, point)) return true;
    HbmOptions fewest = wanted;
    fewest.n_harmonics = highest_excitation(*reduced_);
    if (!guess && fewest.n_harmonics < wanted.n_harmonics &&
        solve_with(fewest, omega, nullptr, StartPaths::affordable, branch, point)) {
        const bool all = climb_harmonics(reduced_, wanted, wanted.n_harmonics, point, watch_);
        if (all || options_.n_harmonics == 0) return true;
    }
    return !affords_paths(*reduced_, wanted) &&
           solve_with(wanted, omega, guess, StartPaths::alone, branch, point);
}

// The curve of harmonic balance where that of exact motions could not be followed to its end; null: none
// begins at omega, or most of its points need not be near any motion.
std::shared_ptr<Branch> Hbm::by_harmonics(double omega) const {
    auto branch = new_branch();
    CurveStart start;
    if (!solve_by_harmonics_at(omega, nullptr, *branch, start.point)) return nullptr;
    trace_curve(options_, start, watch_, *branch);
    return is_worthless(*branch) ? nullptr : branch;
}

// The curve on a model that has what its motions need of the basis; null: such a model would not be much
// smaller, or a curve on it is not what the whole basis says.
std::shared_ptr<Branch> Hbm::sweep_compressed() const {
    constexpr std::int64_t points_of_look = 250;
    constexpr double share_of_look = 1e-2; // of the accuracy: what a few harmonics leave out is much more
    constexpr int most_curves = 3;
    CurveCompression compression(reduced_, options_, 2 * M_PI * options_.frequency_max_hz, watch_);
    Hbm look(*this), curve(*this);
    look.made_as_ = nullptr;
    look.only_looks_ = true;
    look.watch_ = watch_.quiet();
    look.exact_ = false;
    look.options_.motion = MotionKind::harmonics;
    look.options_.n_harmonics = harmonics_of_look(*reduced_);
    look.options_.tolerance = std::max(options_.tolerance, share_of_look * options_.accuracy);
    look.options_.max_points = points_of_look;
    look.options_.stability = StabilityKind::off;
    look.options_.bifurcations = false;
    std::shared_ptr<Branch>
        whole; // the last one that came to its end: there is none better where the effort ends
    try {
        const auto first = look.follow_curve();
        require_unstopped(*first);
        if (!compression.begin_with(*first)) return nullptr;
        for (int k = 0; k < most_curves; ++k) {
            curve.reduced_ = compression.model();
            curve.options_ = options_on(*curve.reduced_, options_);
            const auto branch = curve.follow_curve();
            if (!whole && was_stopped(*branch)) return branch;
            require_unstopped(*branch);
            if (is_stuck(*branch)) return nullptr;
            whole = branch;
            if (!compression.confirms(*branch) && !compression.is_spent()) {
                if (compression.model() == curve.reduced_) return nullptr; // its highest motion is not exact
                continue;
            }
            if (!compression.confirms_stability(*branch)) return nullptr;
            compression.warn(*branch);
            return branch;
        }
    } catch (const Error &e) {
        if (e.status() == PLM_ERR_MEMORY || e.status() == PLM_ERR_CALLBACK) throw;
        if (e.status() != PLM_CANCELLED) return nullptr;
        if (!whole || e.reason() != PLM_REASON_EFFORT) throw;
        compression.warn(*whole);
        return whole;
    }
    return nullptr;
}

std::shared_ptr<Branch> Hbm::sweep_from_its_end() const {
    std::shared_ptr<Branch> branch;
    if (exact_ && options_.motion == MotionKind::automatic && worth_compressing(*reduced_, options_))
        branch = sweep_compressed();
    if (!branch) branch = follow_curve();
    check_span(options_.upward, watch_, *branch);
    return branch;
}

// What comes back, is stuck or finds no first motion from one end may be a whole curve from the other.
std::shared_ptr<Branch> Hbm::sweep_either_way() const {
    std::shared_ptr<Branch> branch;
    std::exception_ptr no_start;
    try {
        branch = sweep_from_its_end();
    } catch (const Error &e) {
        if (e.reason() != PLM_REASON_START_FAILED) throw;
        no_start = std::current_exception();
    }
    if (!branch || (!spans(*branch) && branch->end_reason != PLM_REASON_POINT_LIMIT && !was_stopped(*branch)))
        take_other_way(branch);
    if (!branch) std::rethrow_exception(no_start);
    return branch;
}

// As few harmonics as show the curve, then as many as its points need: the last one that there is effort for.
// Part of a curve of exact motions is worth more than a whole one that need not be near any motion.
void Hbm::take_harmonics(std::shared_ptr<Branch> &branch) const {
    watch_.log(1, "exact motions would take more than the effort allowed: the curve by harmonic balance");
    Hbm other(*this);
    other.exact_ = false;
    other.options_.motion = MotionKind::harmonics;
    for (bool few : {true, false}) {
        other.options_.max_harmonics =
            few ? std::min(harmonics_of_look(*reduced_), options_.max_harmonics) : options_.max_harmonics;
        other.options_.harmonics_by_cost = few;
        within(effort_left(), [&] {
            const auto next = other.sweep_either_way();
            if (!branch || !(was_stopped(*next) || says_more(*branch, *next))) branch = next;
        });
    }
}

std::shared_ptr<const Branch> Hbm::sweep() const {
    constexpr double share_of_exact = 0.9; // of the effort, where harmonics can have the rest
    const Clock::time_point begin = Clock::now();
    std::shared_ptr<Branch> branch;
    const bool has_other = exact_ && options_.motion == MotionKind::automatic;
    within((has_other ? share_of_exact : 1) * effort_left(), [&] { branch = sweep_either_way(); });
    if (has_other && (!branch || branch->end_reason == PLM_REASON_EFFORT)) take_harmonics(branch);
    if (!branch)
        throw Error(PLM_CANCELLED, "no periodic response was found with the effort allowed; raise the effort "
                                   "of the context, or sweep over a smaller range")
            .reason(PLM_REASON_EFFORT);
    check_damping(watch_, *branch);
    judge(*branch);
    branch->seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return branch;
}

std::shared_ptr<const Branch> Hbm::sweep(const Output &asked) const {
    Hbm one(*this);
    one.asked_ = &asked;
    return one.sweep();
}

void Hbm::take_other_way(std::shared_ptr<Branch> &branch) const {
    Hbm back(*this);
    back.options_.upward = !options_.upward;
    watch_.log(
        1, format("no whole curve from the %s end; from the other one", options_.upward ? "lower" : "upper"));
    try {
        const auto other = back.sweep_from_its_end();
        const bool is_better = spans(*other) || other->end_reason == PLM_REASON_POINT_LIMIT;
        if (branch && was_stopped(*other)) branch->end_reason = other->end_reason;
        if (branch && !is_better) return;
        if (branch && branch->end_reason == PLM_REASON_LOOP_CLOSED) other->beside = branch;
        branch = other;
    } catch (const Error &e) { // what the first way found, or why it found nothing, stays
        if (e.status() == PLM_ERR_MEMORY || e.status() == PLM_ERR_CALLBACK) throw;
        if (e.status() != PLM_CANCELLED) return;
        if (!branch) throw;
        branch->end_reason = e.reason();
    }
}

std::shared_ptr<Branch> Hbm::follow_curve() const {
    const Clock::time_point begin = Clock::now();
    auto branch = new_branch();
    const double low = 2 * M_PI * options_.frequency_min_hz, high = 2 * M_PI * options_.frequency_max_hz;
    const double from = options_.upward ? low : high, into = options_.upward ? high - low : low - high;
    // A start inside a super-harmonic region may fail, or find no exact motion, or no solution that more
    // harmonics confirm: the range is entered a little further on then, if that is better.
    CurveStart start;
    bool found = false;
    const bool dear = !affords_paths(*reduced_, with_first_harmonics(*reduced_, options_));
    constexpr int most_attempts = 5;
    constexpr double further_in = 0.02; // of the range: what is left out of the curve is to be small
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        watch_.step("sweep", 0.0);
        BranchPoint point;
        if (!solve_at(from + further_in * attempt * into, nullptr, *branch, point)) continue;
        if (!found || point.harmonic_error < start.point.harmonic_error) start.point = point;
        found = true;
        // an exact motion has all harmonics, whatever its coefficients leave out
        const double enough = exact_ ? options_.allowed_harmonic_error() : worthless_error;
        if (options_.n_harmonics != 0 || start.point.motion || start.point.harmonic_error < enough || dear)
            break;
    }
    if (!found)
        throw Error(
            PLM_ERR_CONVERGENCE,
            format("no periodic response was found at the start of the sweep (%.6g Hz and four neighbours), "
                   "nor at its other end; sweep over another range (frequency_min_hz, frequency_max_hz) or "
                   "with a smaller force_scale%s",
                   from / (2 * M_PI), drift_hint(*reduced_).c_str()))
            .reason(PLM_REASON_START_FAILED);
    trace_curve(options_, start, watch_, *branch);
    if (exact_ && options_.motion == MotionKind::automatic && is_stuck(*branch)) {
        const auto other = by_harmonics(start.point.omega);
        if (other && !is_stuck(*other)) {
            other->newton_work += branch->newton_work;
            other->failed_steps += branch->failed_steps;
            branch = other;
        }
    }
    if (!was_stopped(*branch)) bring_peak_inside(options_, reach_, asked_, watch_, *branch);
    finish(*branch, begin);
    return branch;
}

// What is wrong with a finished curve. One that was stopped is delivered at once.
void Hbm::judge(Branch &curve) const {
    if (was_stopped(curve)) return;
    if (!within(effort_left(), [&] { look_over(curve); }))
        curve.warnings.add(PLM_REASON_EFFORT,
                           "the effort allowed was spent before the curve was compared with the "
                           "whole structure; raise the effort of the context");
}

void Hbm::look_over(Branch &curve) const {
    curve.set_multiplier_error(multiplier_error_of(made_as_, options_, curve,
                                                   std::max(few_flops, flops_of(curve, options_)), watch_));
    check_window(window_, watch_, curve);
    const auto error = [&] {
        const std::int64_t top = largest_response(curve);
        return basis_error_at(made_as_, options_, curve, top, most_moving(curve, top), few_flops, watch_);
    };
    check_basis(window_, error, watch_, curve);
    check_switching(watch_, curve);
}

BranchPoint Hbm::first_guess(const Branch &start, std::int64_t point) const {
    const std::int64_t multiple = options_.period_multiple / start.period_multiple();
    if (multiple * start.period_multiple() != options_.period_multiple)
        throw Error(PLM_ERR_ARGUMENT,
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
    if (start && model_of(*start, "start") != reduced_) { // its coordinates are those of that model
        Hbm there(*this);
        there.reduced_ = model_of(*start, "start");
        there.exact_ = exact_ && there.reduced_ == widened(basis_);
        return there.solve(frequency_hz, start, point);
    }
    if (!(frequency_hz >= smallest_scale && frequency_hz <= largest_scale))
        throw Error(PLM_ERR_ARGUMENT,
                    format("frequency_hz is %g; it must be positive, and squares must neither vanish nor "
                           "overflow (%g to %g)",
                           frequency_hz, smallest_scale, largest_scale))
            .argument("frequency_hz");
    const auto branch = new_branch();
    BranchPoint guess, result;
    if (start) guess = first_guess(*start, point);
    if (!solve_at(2 * M_PI * frequency_hz, start ? &guess : nullptr, *branch, result))
        throw Error(PLM_ERR_CONVERGENCE,
                    format("no periodic response was found at %.6g Hz; give a neighbouring point "
                           "as start or use a sweep%s",
                           frequency_hz, drift_hint(*reduced_).c_str()))
            .argument("frequency_hz")
            .reason(PLM_REASON_START_FAILED);
    Stability stability(reduced_, options_);
    if (stability.wanted() && !result.motion) result.multipliers = stability.multipliers(result);
    if (stability.wanted() && result.multipliers.empty())
        branch->warnings.add(PLM_REASON_UNVERIFIED, stability.unknown_text(1, 1));
    branch->append(std::move(result));
    warn_of_harmonics(with_affordable_harmonics(*reduced_, options_), *branch);
    branch->end_reason = PLM_REASON_RANGE_END;
    branch->unknowns_used = branch->points()[0].motion           ? "state"
                            : prefers_modal(*reduced_, options_) ? "modal"
                                                                 : "gaps";
    check_window(window_, watch_, *branch);
    finish(*branch, begin);
    return branch;
}

} // namespace plm
