#include "searches/computed_response.hpp"
#include "hbm/harmonic_choice.hpp"
#include "linalg/work.hpp"
#include "motions/curve_verdicts.hpp"
#include "orbits/orbit_cost.hpp"
#include "orbits/orbit_points.hpp"
#include "reduction/widened_model.hpp"
#include "searches/basis_error.hpp"
#include "searches/motion_choice.hpp"
#include "searches/refinement.hpp"
#include "searches/sweep.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// The basis reaches as far as the motion: harmonics of the window below which it has all modes.
constexpr std::int64_t more_harmonics[] = {10, 20, 40, 80}, // when a whole curve is followed on each
    looked_at[] = {10, 14, 20, 28, 40, 57, 80};             // when one motion tells
// Points after which a curve is left for that on a larger basis: where one is too small its contact may
// bounce as the structure's does not.
constexpr std::int64_t few_points = 300;
// Where exact motions cost so many flops a step, one of them, found by a curve of few harmonics that takes a
// fraction of theirs, says first whether the basis is worth a curve.
constexpr double worth_a_look = 1e7;
// A step of exact motions on the whole structure: no basis saves anything.
constexpr double cheap_whole = 3e6;
// Of the effort: what curves may have, and what their peak and its error have at least.
constexpr double share_of_curves = 0.75;
// Some seconds.
constexpr double flops_of_first_curve = 1e10;
// Of what is left, for one exact motion: a curve takes some thirty times as much.
constexpr double share_of_look = 0.2;
// Columns beyond which a compressed basis is the better next step than a larger one.
constexpr std::int64_t many_columns = 150;
// For the estimate of an error: some seconds.
constexpr double much_flops = 4e10;

class Chain {
  public:
    Chain(std::shared_ptr<const Model> model, std::shared_ptr<const Space> known, const Output &output,
          double accuracy, double effort, Watch watch)
        : model_(std::move(model)), space_(std::move(known)), output_(output), accuracy_(accuracy),
          effort_(effort), watch_(watch) {
        options_.accuracy = accuracy;
        const double of_host = model_->space_options().reduction_error;
        if (of_host <= allowed_of_host * accuracy) accuracy_ -= of_host; // else check_host_reduction() speaks
    }

    ComputedResponse run() {
        const std::int64_t before = work_done();
        const auto smallest = basis_for(0);
        const double setup = static_cast<double>(work_done() - before);
        ComputedResponse best;
        {
            const Effort effort(std::max(effort_, setup));
            const bool all = within(share_of_curves * effort_left(), [&] { search(smallest, best); });
            spent_ = !all || beyond_reach_;
            if (best.curve)
                within(effort_left(), [&] { is_cut(best) ? find_peak(best) : estimate_error(best); });
            if (!is_cut(best)) look_beside(best);
        }
        if (is_cut(best) || !spans(*best.curve)) take_first_curve(smallest, best);
        finish(best);
        best.setup = setup;
        return best;
    }

  private:
    enum class Follow { to_the_end, few_points };

    // best: what there is whenever the effort is spent.
    void search(const std::shared_ptr<const Basis> &smallest, ComputedResponse &best) {
        const auto first = first_basis(smallest, best);
        if (beyond_reach_) { // no curve of more harmonics is better where they do not converge
            unless_there_is(best, [&] { find_peak(best); });
            if (best.peak.seen_in_time) return;
        }
        unless_there_is(best, [&] {
            follow(first, is_complete(*first) ? Follow::to_the_end : Follow::few_points, best);
        });
        for (std::int64_t h : more_harmonics) {
            if (h <= best.basis->sampler()->n_harmonics()) continue;
            if (!can_improve(best) || is_complete(*best.basis) ||
                best.basis->reduced()->size() >= many_columns)
                break;
            const auto basis = basis_for(h);
            if (basis->reduced()->size() <= best.basis->reduced()->size()) continue; // it knows no more
            if (is_exact(best) && !prefers_exact(widened(basis->reduced()), options_))
                break; // its harmonics would lack more than this basis does
            // if that on the next basis has as many, the contact of the structure itself bounces
            const Follow how = is_cut(best) ? Follow::to_the_end : Follow::few_points;
            if (!take_better(best, [&](ComputedResponse &next) { follow(basis, how, next); })) break;
        }
        if (is_cut(best)) follow(best.basis, Follow::to_the_end, best);
        if (can_improve(best) && std::isfinite(best.error))
            take_better(best, [&](ComputedResponse &next) { next = refined(best); });
    }

    // However little was allowed, there is an answer: a whole curve by few harmonics, where that tells of a
    // larger motion than part of a better one.
    void take_first_curve(const std::shared_ptr<const Basis> &smallest, ComputedResponse &best) {
        if (!best.curve || was_stopped(*best.curve)) spent_ = true;
        const auto look = [&] {
            const auto basis = few_harmonics_.basis ? few_harmonics_.basis : smallest;
            const auto first = curve_of_few_harmonics(basis);
            if (!best.curve || (is_whole(*first) && says_more(*first, *best.curve, watch_)))
                best = with_curve(basis, first);
        };
        unless_there_is(best, [&] { within(flops_of_first_curve, look); });
        if (!best.curve)
            throw Error(status::cancelled,
                        "no periodic response was found with the effort allowed; raise the effort "
                        "of the context")
                .reason(reason::effort);
        const Effort little(flops_of_first_curve);
        if (is_cut(best)) find_peak(best);
    }

    // What finds nothing is no failure where there is an answer already.
    template <class Attempt> static void unless_there_is(const ComputedResponse &best, Attempt attempt) {
        try {
            attempt();
        } catch (const Error &e) {
            if (!best.curve || e.status() != status::convergence) throw;
        }
    }

    bool is_met(const ComputedResponse &r) const { return r.error <= accuracy_; }
    // Given up for its many points: there is no peak yet.
    static bool is_cut(const ComputedResponse &r) { return !r.peak.branch; }
    static bool is_exact(const ComputedResponse &r) { return r.curve && r.curve->points().front().motion; }
    // No other basis knows more.
    bool is_complete(const Basis &basis) const { return basis.reduced()->size() >= model_->n_free(); }
    // A larger basis helps where the curve is whole and has its peak inside, and it can be told by how much.
    bool can_improve(const ComputedResponse &r) const {
        if (is_cut(r)) return true;
        return !is_met(r) && !std::isnan(r.error) && r.curve->end_reason == reason::range_end &&
               !r.peak.branch->warnings.has(reason::no_peak);
    }

    // All of the structure where that is cheap; else the first basis that is not too small by what a curve of
    // few harmonics tells.
    std::shared_ptr<const Basis> first_basis(std::shared_ptr<const Basis> basis, ComputedResponse &best) {
        if (basis->space()->is_contact_space) {
            const auto whole = unreduced_basis(basis, watch_);
            if (prefers_exact(whole->reduced(), options_) && !decays_hopelessly(*whole->reduced()) &&
                exact_step_flops(*whole->reduced(), options_) <= cheap_whole)
                return whole;
        }
        bool too_small = looks_too_small(basis, best);
        for (std::int64_t h : looked_at) {
            if (h <= basis->sampler()->n_harmonics()) continue;
            if (!too_small || basis->reduced()->size() >= many_columns) break;
            basis = basis_for(h);
            too_small = looks_too_small(basis, best);
        }
        return basis;
    }

    // The curve looked at is the first answer.
    bool looks_too_small(const std::shared_ptr<const Basis> &basis, ComputedResponse &best) {
        const auto reduced = widened(basis->reduced());
        const bool exact = prefers_exact(reduced, options_);
        if (exact && exact_step_flops(*reduced, options_) < worth_a_look) return false;
        Branch one(reduced, options_.force_scale);
        try {
            const auto curve = curve_of_few_harmonics(basis);
            if (!best.curve || is_whole(*curve)) best = with_curve(basis, curve);
            if (!exact || !spans(*curve)) return false;
            const bool in_time =
                within(share_of_look * effort_left(), [&] { find_motion_near_peak(*curve, one); });
            if (!in_time) { // a curve of such motions is out of reach
                options_.motion = MotionKind::harmonics;
                beyond_reach_ = true;
            }
            if (one.points().empty()) return false;
        } catch (const Error &e) {
            if (e.status() != status::convergence) throw;
            return false;
        }
        const double error = basis_error_at(basis, options_, one, 0, output_, much_flops, watch_);
        watch_.log(1, format("%lld coordinates: error by the basis %.2g near the peak",
                             static_cast<long long>(basis->reduced()->size()), error));
        looked_at_ = basis, error_near_peak_ = error;
        return std::isfinite(error) && error > accuracy_;
    }

    // Kept: the last one is the first answer where no other comes.
    std::shared_ptr<const Branch> curve_of_few_harmonics(const std::shared_ptr<const Basis> &basis) {
        if (few_harmonics_.basis == basis) return few_harmonics_.curve;
        const auto reduced = widened(basis->reduced());
        const auto curve = Hbm(reduced, basis->sweep_range(), options_, watch_).sweep_with_few_harmonics();
        if (curve->end_reason == reason::cancelled) require_unstopped(*curve);
        if (!was_stopped(*curve)) few_harmonics_ = {basis, curve};
        return curve;
    }

    void find_motion_near_peak(const Branch &curve, Branch &one) const {
        BranchPoint point =
            curve.points()[static_cast<std::size_t>(curve.highest_point(output_.dof, output_.measure, 0))];
        NewtonWork work;
        if (make_exact(one.reduced_model(), options_, watch_, point, work)) one.append(std::move(point));
    }

    // n = 0: as far as the modes reach that are known anyhow.
    std::shared_ptr<const Basis> basis_for(std::int64_t n) {
        SamplerOptions of_sampler;
        of_sampler.n_harmonics = n;
        const auto sampler = std::make_shared<const Sampler>(model_, of_sampler, watch_, space_);
        space_ = sampler->space();
        return std::make_shared<const Basis>(model_, sampler, nullptr, BasisOptions(), watch_);
    }

    // Small, and made of the motions on the last curve, corrected by the whole structure's answer.
    ComputedResponse refined(const ComputedResponse &last) {
        RefinementOptions o;
        o.hbm = last.options;
        o.output = output_;
        o.tolerance = accuracy_;
        const Refinement found = refine(last.basis, o, watch_, last.curve);
        if (!found.basis) throw Error(status::convergence, "no curve on a compressed basis");
        ComputedResponse r = with_curve(found.basis, found.branch);
        find_peak(r);
        return r;
    }

    // The curve is there before its peak is looked for.
    void follow(std::shared_ptr<const Basis> basis, Follow how, ComputedResponse &r) {
        HbmOptions limited = options_;
        if (how == Follow::few_points) limited.max_points = few_points;
        const auto curve = Hbm(basis, limited, watch_).sweep(&output_);
        if (curve->end_reason == reason::cancelled) require_unstopped(*curve);
        if (r.curve && is_whole(*r.curve) && was_stopped(*curve)) return; // what there is goes on to the end
        r = with_curve(std::move(basis), curve);
        if (curve->end_reason != reason::point_limit || how == Follow::to_the_end) find_peak(r);
    }

    ComputedResponse with_curve(std::shared_ptr<const Basis> basis,
                                std::shared_ptr<const Branch> curve) const {
        ComputedResponse r;
        r.basis = std::move(basis), r.options = options_, r.curve = std::move(curve), r.error = INFINITY;
        return r;
    }

    // The host has set no number of points: where this driver did, more of them is a matter of effort.
    void tell_whose_limit(ComputedResponse &r) const {
        if (r.curve->end_reason != reason::point_limit ||
            static_cast<std::int64_t>(r.curve->points().size()) >= options_.max_points)
            return;
        auto told = std::make_shared<Branch>(*r.curve);
        told->end_reason = reason::effort;
        r.curve = std::move(told);
    }

    // The peak of a curve and its error.
    void find_peak(ComputedResponse &r) {
        tell_whose_limit(r);
        Peak peak = Hbm(r.basis, r.options, watch_).find_peak(*r.curve, output_.dof, output_.measure, 0);
        r.peak = std::move(peak);
        r.error = r.peak.basis_error;
        estimate_error(r);
        watch_.log(1, format("%lld coordinates: peak %.6g at %.6g Hz, its error by the basis %.2g",
                             static_cast<long long>(r.basis->reduced()->size()), r.peak.amplitude,
                             r.peak.frequency_hz, r.error));
    }

    // Where the peak came without: for as much as is left.
    void estimate_error(ComputedResponse &r) const {
        if (std::isnan(r.error))
            r.error = basis_error_at(r.basis, r.options, *r.peak.branch, 0, output_, much_flops, watch_);
        if (std::isnan(r.error) && r.basis == looked_at_ && !r.curve->reduced().from)
            r.error = error_near_peak_;
    }

    static bool is_whole(const Branch &curve) { return spans(curve) && !is_worthless(curve); }

    // Where an estimate is not to be had: what a clearly larger basis changes is the error of the one before,
    // and where that is small its own is no larger. Infinite: it is not.
    double change_if_settled(const ComputedResponse &before, const ComputedResponse &after) const {
        constexpr double clearly = 1.2;
        if (is_cut(before) || is_cut(after) ||
            static_cast<double>(after.basis->reduced()->size()) <
                clearly * static_cast<double>(before.basis->reduced()->size()))
            return INFINITY;
        const double change = std::max(std::abs(after.peak.amplitude / before.peak.amplitude - 1),
                                       std::abs(after.peak.frequency_hz / before.peak.frequency_hz - 1));
        return change <= accuracy_ ? change : INFINITY;
    }

    // Of the basis, the harmonics and the path: NaN where one of them is not known.
    static double whole_error(const ComputedResponse &r) {
        return r.error + (r.peak.harmonic_error < 0 ? NAN : r.peak.harmonic_error) + r.peak.above;
    }

    static bool is_better(const ComputedResponse &next, const ComputedResponse &best) {
        const bool larger = next.basis->reduced()->size() > best.basis->reduced()->size();
        if (larger && !std::isfinite(best.error)) return true;
        const double of_next = whole_error(next), of_best = whole_error(best);
        if (std::isnan(of_next) && std::isnan(of_best)) return next.error < best.error;
        return std::isnan(of_best) || of_next < of_best;
    }

    // False: the attempt failed, or a larger basis brought nothing, or no longer a whole curve of motions.
    template <class Attempt> bool take_better(ComputedResponse &best, Attempt attempt) const {
        try {
            ComputedResponse next;
            attempt(next);
            if (!std::isfinite(next.error)) next.error = change_if_settled(best, next);
            const bool better = is_better(next, best) && (is_whole(*next.curve) || !is_whole(*best.curve));
            if (better) best = std::move(next);
            return better;
        } catch (const Error &e) { // what is there already is an answer
            if (e.status() != status::convergence) throw;
            watch_.log(1, std::string("no curve on the next basis: ") + e.what());
            return false;
        }
    }

    // An upper bound, or no number: no less than what the space and the solution leave open.
    void finish(ComputedResponse &r) const {
        tell(r);
        r.error = std::max(r.error, r.options.tolerance + r.basis->space()->error_estimate);
        r.error = whole_error(r) + model_->space_options().reduction_error;
        // what was not followed may be higher by any amount
        const bool is_known = is_whole(*r.curve) || (spans(*r.curve) && r.peak.seen_in_time);
        if (!std::isfinite(r.error) || !is_known || r.peak.branch->warnings.has(reason::no_peak))
            r.error = NAN;
        if (r.larger) watch_.keeping(r.warnings).warn(reason::larger_motion, words_for(*r.larger, known(r)));
        if (spent_ && !(r.error <= options_.accuracy))
            r.warnings.add(
                reason::effort,
                format("the effort allowed was spent before the accuracy, %.2g, was met (estimated error: "
                       "%.2g). This is the best found; raise the effort of the context",
                       options_.accuracy, r.error));
    }

    KnownResponse known(const ComputedResponse &r) const {
        return {r.basis, r.options, r.curve, r.peak.amplitude, output_};
    }

    void look_beside(ComputedResponse &r) const {
        r.looked_beside = within(effort_left(), [&] { r.larger = find_larger_motion(known(r), watch_); });
        if (!r.looked_beside)
            watch_.log(1, "the effort allowed was spent in the search for larger motions beside the curve");
    }

    void tell(ComputedResponse &r) const {
        Warnings all;
        for (const Warning &w : r.curve->warnings.list())
            if (w.reason == reason::model) all.add(w.reason, w.text); // what explains the rest comes first
        if (r.basis->sampler()) all.add(r.basis->sampler()->warnings());
        all.add(r.basis->report().warnings);
        all.add(r.curve->warnings);
        all.add(r.peak.branch->warnings);
        const bool is_peak = !all.has(reason::no_peak);
        for (const Warning &w : all.list())
            if (!(is_met(r) && is_peak && is_about_the_basis(w))) r.warnings.add(w.reason, w.text);
        if (!std::isfinite(r.error) && is_peak)
            r.warnings.add(
                reason::unverified,
                format("how much the basis (%lld coordinates) changes this peak could not be estimated: %s. "
                       "Compare with a basis of your own that is larger",
                       static_cast<long long>(r.basis->reduced()->size()),
                       std::isnan(r.error) ? "there are too many contact pairs for that, or its equations "
                                             "have no unique solution"
                                           : "it is too far from a solution for that"));
    }

    // Signs that it might be unfit, which the estimate of its error outweighs.
    static bool is_about_the_basis(const Warning &w) {
        return w.reason == reason::basis_too_small || w.reason == reason::outside_basis ||
               w.reason == reason::no_contraction;
    }

    std::shared_ptr<const Model> model_;
    std::shared_ptr<const Space> space_;
    Output output_;
    double accuracy_;           // of the basis
    double effort_;             // flops
    bool spent_ = false;        // the effort, before all was done
    bool beyond_reach_ = false; // one exact motion takes more than its share
    struct {
        std::shared_ptr<const Basis> basis;
        std::shared_ptr<const Branch> curve;
    } few_harmonics_;
    std::shared_ptr<const Basis> looked_at_;
    double error_near_peak_ = NAN; // by that basis
    Watch watch_;
    HbmOptions options_;
};

} // namespace

ComputedResponse compute_response(std::shared_ptr<const Model> model, std::shared_ptr<const Space> known,
                                  const Output &output, double accuracy, double effort, Watch watch) {
    return Chain(std::move(model), std::move(known), output, accuracy, effort, watch).run();
}

} // namespace plm
