#include "searches/computed_response.hpp"
#include "reduction/widened_model.hpp"
#include "searches/basis_error.hpp"
#include "searches/curve_verdicts.hpp"
#include "searches/harmonic_choice.hpp"
#include "searches/orbit_points.hpp"
#include "searches/refinement.hpp"
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
// Where contact of the structure itself bounces, a curve may wind without end: what a curve may cost in
// flops, and the points that it has anyhow.
constexpr double most_flops = 1.5e9;
constexpr std::int64_t points_anyhow = 500;
// Curves that have cost so many flops together: not another one on a larger basis, but on one that is made of
// their motions.
constexpr double much_work = 1.5e10;
// Where exact motions cost so many flops a step, one of them, found by a curve of few harmonics that takes a
// fraction of theirs, says first whether the basis is worth a curve.
constexpr double worth_a_look = 1e7;
constexpr std::int64_t harmonics_of_look = 5, points_of_look = 250;
// A step of exact motions on the whole structure: no basis saves anything.
constexpr double cheap_whole = 3e6;
// Columns beyond which a compressed basis is the better next step than a larger one.
constexpr std::int64_t many_columns = 150;
// For the estimate of an error: some seconds.
constexpr double much_flops = 4e10;

class Chain {
  public:
    Chain(std::shared_ptr<const Model> model, std::shared_ptr<const Space> known, const Output &output,
          double accuracy, Watch watch)
        : model_(std::move(model)), space_(std::move(known)), output_(output), accuracy_(accuracy),
          watch_(watch) {
        options_.accuracy = accuracy;
        const double of_host = model_->space_options().reduction_error;
        if (of_host <= allowed_of_host * accuracy) accuracy_ -= of_host; // else check_host_reduction() speaks
    }

    ComputedResponse run() {
        const auto first = first_basis();
        ComputedResponse best = on(first, is_complete(*first) ? Follow::to_the_end : Follow::few_points);
        for (std::int64_t h : more_harmonics) {
            if (h <= best.basis->sampler()->n_harmonics()) continue;
            if (!can_improve(best) || is_complete(*best.basis) ||
                best.basis->reduced()->size() >= many_columns || (work_ > much_work && !is_cut(best)))
                break;
            const auto basis = basis_for(h);
            if (basis->reduced()->size() <= best.basis->reduced()->size()) continue; // it knows no more
            // if that on the next basis has as many, the contact of the structure itself bounces
            const Follow how = is_cut(best) ? Follow::to_the_end : Follow::few_points;
            if (!take_better(best, [&] { return on(basis, how); })) break;
        }
        if (is_cut(best)) best = on(best.basis, Follow::to_the_end);
        if (can_improve(best) && std::isfinite(best.error)) take_better(best, [&] { return refined(best); });
        finish(best);
        return best;
    }

  private:
    enum class Follow { to_the_end, few_points };

    bool is_met(const ComputedResponse &r) const { return r.error <= accuracy_; }
    // Given up for its many points: there is no peak yet.
    static bool is_cut(const ComputedResponse &r) { return !r.peak.branch; }
    // No other basis knows more.
    bool is_complete(const Basis &basis) const { return basis.reduced()->size() >= model_->n_free(); }
    // A larger basis helps where the curve is whole and has its peak inside, and it can be told by how much.
    bool can_improve(const ComputedResponse &r) const {
        if (is_cut(r)) return true;
        return !is_met(r) && !std::isnan(r.error) && r.curve->end_reason == PLM_REASON_RANGE_END &&
               !r.peak.branch->warnings.has(PLM_REASON_NO_PEAK);
    }

    // All of the structure where that is cheap; else the first basis that is not too small by what a curve of
    // few harmonics tells.
    std::shared_ptr<const Basis> first_basis() {
        std::shared_ptr<const Basis> basis = basis_for(0);
        if (basis->space()->is_contact_space) {
            const auto whole = unreduced_basis(basis, watch_);
            if (prefers_exact(whole->reduced(), options_) && !decays_hopelessly(*whole->reduced()) &&
                exact_step_flops(*whole->reduced(), options_) <= cheap_whole)
                return whole;
        }
        for (std::int64_t h : looked_at) {
            if (h <= basis->sampler()->n_harmonics()) continue;
            if (basis->reduced()->size() >= many_columns || !looks_too_small(basis)) break;
            basis = basis_for(h);
        }
        return basis;
    }

    bool looks_too_small(const std::shared_ptr<const Basis> &basis) const {
        const auto reduced = widened(basis->reduced());
        if (!prefers_exact(reduced, options_) || exact_step_flops(*reduced, options_) < worth_a_look)
            return false;
        Branch one(reduced, options_.force_scale);
        try {
            if (!find_motion_near_peak(*basis, one)) return false;
        } catch (const Error &e) {
            if (e.status() != PLM_ERR_CONVERGENCE) throw;
            return false;
        }
        const double error = basis_error_at(basis, options_, one, 0, output_, much_flops, watch_);
        watch_.log(1, format("%lld coordinates: error by the basis %.2g near the peak",
                             static_cast<long long>(basis->reduced()->size()), error));
        return std::isfinite(error) && error > accuracy_;
    }

    bool find_motion_near_peak(const Basis &basis, Branch &one) const {
        HbmOptions o = options_;
        o.motion = MotionKind::harmonics;
        o.n_harmonics = harmonics_of_look;
        o.max_points = points_of_look;
        o.stability = StabilityKind::off;
        const auto curve = Hbm(one.reduced_model(), basis.sweep_range(), o, watch_).sweep();
        require_uncancelled(*curve);
        if (!spans(*curve)) return false;
        BranchPoint point =
            curve->points()[static_cast<std::size_t>(curve->highest_point(output_.dof, output_.measure, 0))];
        NewtonWork work;
        if (!make_exact(one.reduced_model(), options_, watch_, point, work)) return false;
        one.append(std::move(point));
        return true;
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
        if (!found.basis) throw Error(PLM_ERR_CONVERGENCE, "no curve on a compressed basis");
        ComputedResponse r;
        r.basis = found.basis;
        r.options = last.options;
        r.curve = found.branch;
        return with_peak(std::move(r));
    }

    std::int64_t most_points(const Basis &basis) const {
        const double affordable = most_flops / exact_step_flops(*widened(basis.reduced()), options_);
        return std::clamp(static_cast<std::int64_t>(std::min(affordable, 1e9)), points_anyhow,
                          options_.max_points);
    }

    ComputedResponse on(std::shared_ptr<const Basis> basis, Follow how) {
        ComputedResponse r;
        r.basis = std::move(basis);
        r.options = options_;
        r.error = INFINITY;
        HbmOptions limited = options_;
        limited.max_points = how == Follow::few_points ? few_points : most_points(*r.basis);
        r.curve = Hbm(r.basis, limited, watch_).sweep(output_);
        require_uncancelled(*r.curve);
        work_ += static_cast<double>(r.curve->newton_work.iterations) *
                 exact_step_flops(r.curve->reduced(), options_);
        if (r.curve->end_reason == PLM_REASON_POINT_LIMIT && how == Follow::few_points) return r;
        return with_peak(std::move(r));
    }

    // The peak of a curve and its error.
    ComputedResponse with_peak(ComputedResponse r) {
        r.peak = Hbm(r.basis, r.options, watch_).find_peak(*r.curve, output_.dof, output_.measure, 0);
        r.error = basis_error_at(r.basis, r.options, *r.peak.branch, 0, output_, much_flops, watch_);
        watch_.log(1, format("%lld coordinates: peak %.6g at %.6g Hz, its error by the basis %.2g",
                             static_cast<long long>(r.basis->reduced()->size()), r.peak.amplitude,
                             r.peak.frequency_hz, r.error));
        return r;
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

    // False: the attempt failed, or a larger basis brought nothing, or no longer a whole curve of motions.
    template <class Attempt> bool take_better(ComputedResponse &best, Attempt attempt) const {
        try {
            ComputedResponse next = attempt();
            if (!std::isfinite(next.error)) next.error = change_if_settled(best, next);
            const bool larger = next.basis->reduced()->size() > best.basis->reduced()->size(),
                       better = (next.error < best.error || (larger && !std::isfinite(best.error))) &&
                                (is_whole(*next.curve) || !is_whole(*best.curve));
            if (better) best = std::move(next);
            return better;
        } catch (const Error &e) { // what is there already is an answer
            if (e.status() != PLM_ERR_CONVERGENCE) throw;
            watch_.log(1, std::string("no curve on the next basis: ") + e.what());
            return false;
        }
    }

    // An upper bound, or no number: no less than what the space and the solution leave open.
    void finish(ComputedResponse &r) const {
        tell(r);
        r.error = std::max(r.error, r.options.tolerance + r.basis->space()->error_estimate) +
                  model_->space_options().reduction_error;
        const BranchPoint &top = r.peak.branch->points()[0];
        if (!top.motion) r.error += top.harmonic_error < 0 ? NAN : top.harmonic_error;
        // what was not followed may be higher by any amount
        if (!std::isfinite(r.error) || !is_whole(*r.curve) || r.peak.branch->warnings.has(PLM_REASON_NO_PEAK))
            r.error = NAN;
        look_beside(r);
    }

    void look_beside(ComputedResponse &r) const {
        const KnownResponse known = {r.basis, r.options, r.curve, r.peak.amplitude, output_};
        r.larger = find_larger_motion(known, watch_);
        if (r.larger) watch_.keeping(r.warnings).warn(PLM_REASON_LARGER_MOTION, words_for(*r.larger, known));
    }

    void tell(ComputedResponse &r) const {
        Warnings all;
        if (r.basis->sampler()) all.add(r.basis->sampler()->warnings());
        all.add(r.basis->report().warnings);
        all.add(r.curve->warnings);
        all.add(r.peak.branch->warnings);
        const bool is_peak = !all.has(PLM_REASON_NO_PEAK);
        for (const Warning &w : all.list())
            if (!(is_met(r) && is_peak && is_about_the_basis(w))) r.warnings.add(w.reason, w.text);
        if (!std::isfinite(r.error) && is_peak)
            r.warnings.add(
                PLM_REASON_UNVERIFIED,
                format("how much the basis (%lld coordinates) changes this peak could not be estimated: %s. "
                       "Compare with a basis of your own that is larger",
                       static_cast<long long>(r.basis->reduced()->size()),
                       std::isnan(r.error) ? "there are too many contact pairs for that, or its equations "
                                             "have no unique solution"
                                           : "it is too far from a solution for that"));
    }

    // Signs that it might be unfit, which the estimate of its error outweighs.
    static bool is_about_the_basis(const Warning &w) {
        return w.reason == PLM_REASON_BASIS_TOO_SMALL || w.reason == PLM_REASON_OUTSIDE_BASIS ||
               w.reason == PLM_REASON_NO_CONTRACTION;
    }

    std::shared_ptr<const Model> model_;
    std::shared_ptr<const Space> space_;
    Output output_;
    double accuracy_; // of the basis
    double work_ = 0; // of the curves, flops
    Watch watch_;
    HbmOptions options_;
};

} // namespace

ComputedResponse compute_response(std::shared_ptr<const Model> model, std::shared_ptr<const Space> known,
                                  const Output &output, double accuracy, Watch watch) {
    return Chain(std::move(model), std::move(known), output, accuracy, watch).run();
}

} // namespace plm
