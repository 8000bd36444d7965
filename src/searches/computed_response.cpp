#include "searches/computed_response.hpp"
#include "hbm/harmonic_choice.hpp"
#include "linalg/work.hpp"
#include "motions/curve_verdicts.hpp"
#include "motions/effort_budget.hpp"
#include "motions/error_budget.hpp"
#include "motions/motion_measures.hpp"
#include "orbits/larger_in_time.hpp"
#include "orbits/mean_motion.hpp"
#include "orbits/orbit_cost.hpp"
#include "reduction/widened_model.hpp"
#include "searches/basis_error.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/refinement.hpp"
#include "searches/sweep.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Coordinates of the unreduced structure up to which curves are followed on it, by harmonics in its gaps or
// by exact motions on what they need of it: its matrices are nothing beside a curve then, and no basis adds
// an error of its own.
constexpr std::int64_t few_coordinates = 600;

class Chain {
  public:
    Chain(std::shared_ptr<const Model> model, std::shared_ptr<const Space> known, const Output &output,
          double accuracy, double effort, Watch watch)
        : model_(std::move(model)), space_(std::move(known)), output_(output), accuracy_(accuracy),
          effort_(effort), watch_(watch) {
        options_.accuracy = accuracy;
        const double of_host = model_->space_options().reduction_error;
        if (of_host <= ErrorBudget(accuracy).host())
            accuracy_ -= of_host; // else check_host_reduction() speaks
    }

    ComputedResponse run() {
        watch_.log(1, ErrorBudget(options_.accuracy).text(options_.allowed_harmonic_error()));
        const std::int64_t before = work_done();
        const auto smallest = basis_for(0);
        const double setup = static_cast<double>(work_done() - before);
        ComputedResponse best;
        {
            const Effort effort(std::max(effort_, setup));
            const bool all = within(EffortBudget::most * effort_left(), [&] { search(smallest, best); });
            spent_ = !all;
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
    // best: what there is whenever the effort is spent.
    void search(const std::shared_ptr<const Basis> &smallest, ComputedResponse &best) {
        if (smallest->space()->size() <= few_coordinates)
            take_better(best,
                        [&](ComputedResponse &next) { follow(unreduced_basis(smallest, watch_), next); });
        if (!best.curve)
            follow(smallest, best);
        else if (!is_whole(*best.curve))
            take_better(best, [&](ComputedResponse &next) { follow(smallest, next); });
        if (can_improve(best)) take_better(best, [&](ComputedResponse &next) { refine_from(best, next); });
    }

    // However little was allowed, there is an answer: part of a good curve, or a whole one by few harmonics
    // where that is worth more.
    void take_first_curve(const std::shared_ptr<const Basis> &smallest, ComputedResponse &best) {
        if (!best.curve || was_stopped(*best.curve)) spent_ = true;
        ComputedResponse first;
        const auto look = [&] {
            first = look_ ? with_curve(look_basis_, look_)
                          : with_curve(smallest, curve_of_few_harmonics(*smallest));
        };
        unless_there_is(best, [&] { within(EffortBudget::first_curve, look); });
        if (!best.curve && !first.curve)
            throw Error(status::cancelled,
                        "no periodic response was found with the effort allowed; raise the effort "
                        "of the context")
                .reason(reason::effort);
        const Effort little(EffortBudget::first_curve);
        if (best.curve && is_cut(best)) find_peak(best);
        if (!first.curve || (best.curve && !is_whole(*first.curve))) return;
        find_peak(first);
        if (!best.curve || is_worth_more(first, best)) best = std::move(first);
    }

    // Where it tells of a larger motion, or of none beyond its own error: then that is known, and what part
    // of a curve leaves out is not.
    bool is_worth_more(const ComputedResponse &first, const ComputedResponse &part) const {
        const double error = whole_error(first); // NaN: not known
        return (error <= ErrorBudget::trusted && (1 + error) * first.peak.amplitude >= part.peak.amplitude) ||
               says_more(*first.curve, *part.curve, watch_);
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
    // A better basis helps where the curve is whole and has its peak inside, and it can be told by how much.
    bool can_improve(const ComputedResponse &r) const {
        return std::isfinite(r.error) && !is_met(r) && r.curve->end_reason == reason::range_end &&
               !r.peak.branch->warnings.has(reason::no_peak);
    }

    std::shared_ptr<const Branch> curve_of_few_harmonics(const Basis &basis) const {
        const auto curve =
            Hbm(widened(basis.reduced()), basis.sweep_range(), options_, watch_).sweep_with_few_harmonics();
        if (curve->end_reason == reason::cancelled) require_unstopped(*curve);
        return curve;
    }

    // What exact curves begin with, and the answer where there is no effort for them.
    void look_at(const std::shared_ptr<const Basis> &basis) {
        if (look_basis_ == basis || !compresses(*widened(basis->reduced()), options_)) return;
        look_ = nullptr, look_basis_ = basis;
        const auto curve = curve_of_few_harmonics(*basis);
        if (!was_stopped(*curve)) look_ = curve;
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
    void refine_from(const ComputedResponse &last, ComputedResponse &r) {
        RefinementOptions o;
        o.hbm = last.options;
        o.output = output_;
        o.tolerance = accuracy_;
        const Refinement found = refine(last.basis, o, watch_, last.curve);
        if (!found.basis) throw Error(status::convergence, "no curve on a compressed basis");
        r = with_curve(found.basis, found.branch);
        find_peak(r);
    }

    // The curve is there before its peak is looked for.
    void follow(std::shared_ptr<const Basis> basis, ComputedResponse &r) {
        look_at(basis);
        HbmOptions options = options_;
        options.upward = look_ && begins_below(*look_);
        const auto curve = Hbm(basis, options, watch_).sweep(&output_, nullptr, look_);
        if (curve->end_reason == reason::cancelled) require_unstopped(*curve);
        r = with_curve(std::move(basis), curve);
        find_peak(r);
    }

    // A curve that takes more than the effort allowed is begun at the end that is nearer to its peak.
    bool begins_below(const Branch &look) const {
        const double step = EffortBudget::step_on_compressed * exact_step_flops(look.reduced(), options_);
        if (static_cast<double>(look.newton_work.iterations) * step < effort_left()) return false;
        const std::int64_t top = largest_response(look), n = static_cast<std::int64_t>(look.points().size());
        return (2 * top < n) == (look.points().front().omega < look.points().back().omega);
    }

    ComputedResponse with_curve(std::shared_ptr<const Basis> basis,
                                std::shared_ptr<const Branch> curve) const {
        ComputedResponse r;
        r.basis = std::move(basis), r.options = options_, r.curve = std::move(curve), r.error = INFINITY;
        return r;
    }

    // The peak of a curve and its error.
    void find_peak(ComputedResponse &r) {
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
            r.error = basis_error_at(r.basis, r.options, *r.peak.branch, 0, output_,
                                     EffortBudget::last_estimate, watch_);
    }

    static bool is_whole(const Branch &curve) { return spans(curve) && !is_worthless(curve); }

    // Of the basis, the harmonics and the path: NaN where one of them is not known.
    static double whole_error(const ComputedResponse &r) {
        return r.error + (r.peak.harmonic_error < 0 ? NAN : r.peak.harmonic_error) + r.peak.above;
    }

    static bool is_better(const ComputedResponse &next, const ComputedResponse &best) {
        if (is_whole(*next.curve) != is_whole(*best.curve)) return is_whole(*next.curve);
        const double of_next = whole_error(next), of_best = whole_error(best);
        if (std::isnan(of_next) && std::isnan(of_best)) return next.error < best.error;
        return std::isnan(of_best) || of_next < of_best;
    }

    // What is there already is an answer, and an attempt that fails no reason to lose it.
    template <class Attempt> void take_better(ComputedResponse &best, Attempt attempt) const {
        try {
            if (!best.curve) return attempt(best);
            ComputedResponse next;
            attempt(next);
            if (is_better(next, best)) best = std::move(next);
        } catch (const Error &e) {
            if (e.status() != status::convergence) throw;
            watch_.log(1, std::string("no curve on the next basis: ") + e.what());
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
        if (r.in_time)
            watch_.keeping(r.warnings).warn(reason::larger_motion, words_for(*r.in_time, r.peak.amplitude));
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
        within(effort_left(), [&] {
            r.in_time = find_larger_in_time(*r.curve, output_, r.peak.amplitude, options_.accuracy, watch_);
        });
        const bool all = within(effort_left(), [&] { r.larger = find_larger_motion(known(r), watch_); });
        r.looked_beside =
            all && !r.basis->reduced()->whole_contact().moves(); // then resonances do not show it
        if (!all)
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
    double accuracy_;    // of the basis
    double effort_;      // flops
    bool spent_ = false; // the effort, before all was done
    std::shared_ptr<const Basis> look_basis_;
    std::shared_ptr<const Branch> look_; // a curve of few harmonics on it
    Watch watch_;
    HbmOptions options_;
};

} // namespace

ComputedResponse compute_response(std::shared_ptr<const Model> model, std::shared_ptr<const Space> known,
                                  const Output &output, double accuracy, double effort, Watch watch) {
    return Chain(std::move(model), std::move(known), output, accuracy, effort, watch).run();
}

} // namespace plm
