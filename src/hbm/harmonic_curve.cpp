#include "hbm/harmonic_curve.hpp"
#include "hbm/formulation.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "motions/first_harmonics.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t patience = 5;            // points between changes to something cheaper
constexpr std::int64_t most_failed_growths = 3; // in a row, from points that say nothing

class HarmonicTracer final : public CurveTracer {
  public:
    HarmonicTracer(const HbmOptions &options, const MultipliersOf &multipliers, Watch watch, Branch &branch,
                   CurveRecorder *recorder)
        : CurveTracer(nullptr, options, watch, branch, recorder),
          asked_(with_affordable_harmonics(*branch.reduced_model(), options)), options_(asked_),
          reduced_(branch.reduced_model()), multipliers_(multipliers),
          fewest_(std::max<std::int64_t>(3, highest_excitation(*reduced_))) {}

    void trace(const CurveStart &start) {
        has_side_ = !start.towards.empty();
        options_.n_harmonics = start.point.n_harmonics / options_.period_multiple;
        limit_harmonics(start.point);
        wants_modal_ = modal_ = prefers_modal(*reduced_, options_);
        options_.unknowns = modal_ ? NonlinearUnknowns::modal : NonlinearUnknowns::gaps;
        compliant_ = make_formulation(*reduced_, options_).compliant;
        branch_.unknowns_used = modal_ ? "modal" : "gaps";
        branch_.sampled = options_.aft == AftKind::sampled;
        omega_ = start.point.omega;
        if (known()) take(*known());
        system_ = make(options_);
        equations_ = system_.get();
        run(start);
        warn_of_harmonics(asked_, branch_);
    }

    void record(const PathPoint &p) override {
        BranchPoint point = point_of(p);
        point.arclength += base_arclength_;
        look_at_harmonics(p.x, point);
        moved_most_ = std::max(moved_most_, point.n_switching);
        branch_.append(std::move(point));
    }

    bool interrupt() override {
        ++since_change_;
        const bool grow = may_grow();
        rejects_ = grow && can_reject();
        if (!rejects_) n_kept_ = n_points();
        changes_ = grow;
        if (since_change_ >= patience) {
            choose_space();
            changes_ = grow || wanted_harmonics_ < options_.n_harmonics || wants_modal_ != modal_;
        }
        return CurveTracer::interrupt() || changes_;
    }

  protected:
    void follow_on(const PathOptions &range, const PathStart &start) override {
        PathOptions limits = range;
        if (known()) {
            system_->take(known()->memory);
            limits.max_points = asked_.max_points - (n_points() - known()->path.n_recorded);
        }
        PathOutcome out = known() ? go_on_with_path(*system_, limits, known()->path, *this)
                                  : follow_path(*system_, limits, start, *this);
        for (;;) {
            take_outcome(out, branch_);
            const bool ended = out.end_reason != reason::none;
            // its owner is not asked after the point at the range's end
            if (out.end_reason == reason::range_end) rejects_ = may_grow() && can_reject();
            if (ended && !(out.end_reason == reason::range_end && rejects_)) break;
            if (!ended && !changes_) {
                stand(out, choices());
                out = go_on_with_path(*system_, limits, out, *this);
                continue;
            }
            base_arclength_ += out.arclength;
            PathStart path = resume(out);
            if (!change_system(out.orientation, path) && ended) break;
            if (failed_growths_ >= most_failed_growths) {
                branch_.end_reason = reason::harmonics_too_few;
                break;
            }
            limits.max_points = asked_.max_points - n_points();
            limits.initial_step = out.step;
            out = follow_path(*system_, limits, path, *this);
        }
    }

  private:
    std::unique_ptr<HarmonicEquations> make(const HbmOptions &options) const {
        return std::make_unique<HarmonicEquations>(reduced_, options, omega_, multipliers_);
    }

    // Where the first point could not be had to the tolerance, more harmonics did not help there: the curve
    // is not made worse, nor slow, by trying them at every point.
    void limit_harmonics(const BranchPoint &first) {
        limits_ = asked_;
        if (first.harmonic_error > 10 * asked_.allowed_harmonic_error())
            limits_.max_harmonics = options_.n_harmonics;
    }

    bool may_grow() const { return wanted_harmonics_ > options_.n_harmonics && since_change_ > blocked_; }
    // Back to the last point with enough harmonics; from the first one the side is known by the range only.
    bool can_reject() const { return n_kept_ > (has_side_ ? 1 : 0); }
    double window_width() const { return 2 * M_PI * (options_.frequency_max_hz - options_.frequency_min_hz); }

    std::int64_t n_points() const { return static_cast<std::int64_t>(branch_.points().size()); }

    HarmonicChoices choices() const {
        return {options_.n_harmonics, modal_,        wants_modal_, rejects_,    n_kept_,
                wanted_harmonics_,    since_change_, blocked_,     moved_most_, failed_growths_,
                base_arclength_};
    }

    void take(const CurveProgress &known) {
        const HarmonicChoices &c = known.harmonics;
        options_.n_harmonics = std::min(std::max<std::int64_t>(c.n_harmonics, 1),
                                        std::max(options_.n_harmonics, asked_.max_harmonics));
        modal_ = c.modal, wants_modal_ = c.wants_modal, rejects_ = c.rejects;
        n_kept_ = c.n_kept, wanted_harmonics_ = c.wanted_harmonics, since_change_ = c.since_change;
        blocked_ = c.blocked, moved_most_ = c.moved_most, failed_growths_ = c.failed_growths;
        base_arclength_ = c.base_arclength;
        options_.unknowns = modal_ ? NonlinearUnknowns::modal : NonlinearUnknowns::gaps;
        branch_.unknowns_used = known.unknowns_used;
    }

    void look_at_harmonics(const vector<double> &x, BranchPoint &point) {
        wanted_harmonics_ = options_.n_harmonics;
        const bool needed = asked_.n_harmonics == 0 || asked_.tail_correction;
        if (!needed && !reduced_->damping.empty()) return; // a dense factorization for each harmonic
        const HarmonicContent content = harmonic_content(*reduced_, point, options_.period_multiple);
        point.harmonic_tail = content.tail;
        if (asked_.n_harmonics == 0) {
            point.harmonic_error = harmonic_error(*reduced_, point,
                                                  harmonic_change(*reduced_, point, options_.period_multiple,
                                                                  content, system_->system(), x.data()));
            wanted_harmonics_ =
                next_harmonics(limits_, fewest_, options_.n_harmonics, content, point.harmonic_error);
        }
        if (!asked_.tail_correction) return;
        point.eta.append(content.tail_response);
    }

    // By the cubic cost of the dense factorization, with some inertia.
    void choose_space() {
        constexpr double to_gaps = 1.5, to_modal = 1.2; // a change costs a factorization and a metric
        wants_modal_ = modal_;
        if (asked_.unknowns == NonlinearUnknowns::automatic && reduced_->n_pairs() > 0 && !compliant_) {
            const double r = static_cast<double>(reduced_->size()), moving = static_cast<double>(moved_most_);
            if (modal_ && to_gaps * moving < r) wants_modal_ = false;
            if (!modal_ && moving > to_modal * r) wants_modal_ = true;
        }
        moved_most_ = 0;
    }

    // The last point kept in the new system, corrected across the direction travelled; the old system goes on
    // from `path` when that fails (false). More harmonics are taken in smaller numbers then: the curve of
    // many may turn away from that of few, but the next ones are near.
    bool change_system(double orientation, PathStart &path) {
        since_change_ = 0;
        for (std::int64_t more = wanted_harmonics_ - options_.n_harmonics;; more /= 2) {
            HbmOptions changed = options_;
            changed.n_harmonics += more;
            changed.unknowns = wants_modal_ ? NonlinearUnknowns::modal : NonlinearUnknowns::gaps;
            if (change_to(changed, orientation, path)) return true;
            if (more <= 1) break;
        }
        keep_system();
        return false;
    }

    bool change_to(const HbmOptions &changed, double orientation, PathStart &path) {
        auto next = make(changed);
        take(next);
        std::int64_t n = rejects_ ? n_kept_ : n_points();
        PathStart other;
        if (!go_on_from(n, changed.n_harmonics, orientation, other)) {
            take(next);
            return false;
        }
        blocked_ = 0;
        failed_growths_ = 0;
        base_arclength_ = branch_.points()[static_cast<std::size_t>(n - 1)].arclength;
        branch_.truncate(n);
        n_kept_ = n;
        if (wants_modal_ != modal_) branch_.unknowns_used = "both";
        options_ = changed;
        modal_ = wants_modal_;
        set_end(other);
        path = other;
        return true;
    }

    void take(std::unique_ptr<HarmonicEquations> &next) {
        next.swap(system_);
        equations_ = system_.get();
    }

    // On with what there is, for a while; not for ever where its points say nothing.
    void keep_system() {
        blocked_ = 4 * patience;
        const bool worthless = branch_.points().back().harmonic_error > worthless_error;
        if (wanted_harmonics_ > options_.n_harmonics) failed_growths_ = worthless ? failed_growths_ + 1 : 0;
        wanted_harmonics_ = options_.n_harmonics;
        wants_modal_ = modal_;
        n_kept_ = n_points();
    }

    // The n-th point in the present system or, when that sees another stability there, one of those before
    // it: otherwise a bifurcation would be passed twice, or not at all. Fewer harmonics have to see the same.
    // Where the present system has a corner in between, its curve would be followed back. A bifurcation just
    // passed with too few harmonics is located again with more.
    bool go_on_from(std::int64_t &n, std::int64_t harmonics, double orientation, PathStart &path) {
        const bool fewer = harmonics < options_.n_harmonics;
        const std::int64_t last = n;
        if (!go_on_from_point(last, path)) return false;
        const bool possible = keeps_direction(last, orientation, path);
        if (fewer) return possible && same_stability(last, path);
        PathStart earlier = path;
        std::int64_t behind = 0; // the first point that would do, but for a bifurcation before it
        bool passed = false;
        for (; n > 2 && n > last - patience; --n) {
            const BranchPoint &at = branch_.points()[static_cast<std::size_t>(n - 1)];
            if (at.bifurcation != bifurcation::none) {
                if (behind > 0 && at.n_harmonics < harmonics * options_.period_multiple) passed = true;
                continue;
            }
            if (n < last && !go_on_from_point(n, earlier)) break;
            if (!same_stability(n, earlier) || !keeps_direction(n, orientation, earlier)) continue;
            if (behind == 0 || passed) path = earlier;
            if (passed) return true;
            if (behind == 0) behind = n;
            if (!located_with_fewer(last - patience, n - 1, harmonics)) break;
        }
        n = behind > 0 ? behind : last;
        return behind > 0 || possible;
    }

    // Whether one of the points before the n-th, but not before the first, is such a bifurcation.
    bool located_with_fewer(std::int64_t first, std::int64_t n, std::int64_t harmonics) const {
        for (std::int64_t i = std::max<std::int64_t>(first, 0); i < n; ++i) {
            const BranchPoint &p = branch_.points()[static_cast<std::size_t>(i)];
            if (p.bifurcation != bifurcation::none && p.n_harmonics < harmonics * options_.period_multiple)
                return true;
        }
        return false;
    }

    // Whether the path in the present system leaves its start along the direction given, with the
    // orientation that the path before it had. (Harmonics more or less do not change the sign of the
    // determinant: those of the structure alone have a positive one. Other unknowns may.)
    bool keeps_direction(std::int64_t n, double orientation, const PathStart &path) {
        if (n == 1) return true; // into the range
        const Metric metric = metric_at(path.at);
        vector<double> r(system_->size());
        system_->residual(path.at.x.data(), path.at.parameter, r.data());
        system_->linearize();
        ++branch_.newton_work.factorizations;
        const double along = metric.cosine(tangent_at(*system_), path.direction);
        constexpr double same_way = 0.8; // as far as harmonics more or less turn a curve
        if (!(std::abs(along) > same_way)) return false;
        return wants_modal_ != modal_ ||
               system_->determinant_sign() * (along < 0 ? -1.0 : 1.0) * orientation > 0;
    }

    Metric metric_at(const PathState &at) const {
        const double size = norm2(system_->size(), at.x.data());
        return {size > 0 ? size : 1, window_width()};
    }

    bool go_on_from_point(std::int64_t n, PathStart &path) {
        const BranchPoint &at = branch_.points()[static_cast<std::size_t>(n - 1)];
        path = leaving(at, n > 1 ? branch_.points()[static_cast<std::size_t>(n - 2)] : at);
        path.record = false;
        scale_by(-1, path.direction); // on, not back
        if (n == 1) path.direction.parameter = options_.upward ? 1 : -1;
        return correct(path);
    }

    bool same_stability(std::int64_t n, const PathStart &path) {
        const vector<std::complex<double>> &before =
            branch_.points()[static_cast<std::size_t>(n - 1)].multipliers;
        if (!multipliers_ || before.empty()) return true;
        const vector<double> a = bifurcation_tests(before),
                             b = bifurcation_tests(system_->multipliers(path.at.x, path.at.parameter));
        for (std::size_t k = 0; k < a.size(); ++k)
            if (a[k] * b[k] < 0) return false;
        return true;
    }

    // Where the curve began, as the present system sees it: a loop has to meet it.
    void set_end(PathStart &path) {
        if (n_points() < 2) return;
        PathStart origin = leaving(branch_.points()[0], branch_.points()[1]);
        if (!correct(origin)) origin = leaving(branch_.points()[0], branch_.points()[1]);
        path.end = origin.at;
        path.end_direction = origin.direction;
    }

    PathStart resume(const PathOutcome &out) const {
        PathStart path;
        path.at = out.at;
        path.direction = out.direction;
        path.scale = out.scale;
        path.record = false;
        return path;
    }

    bool correct(PathStart &path) {
        const Metric metric = metric_at(path.at);
        NewtonLimits limits = newton_limits(options_);
        limits.min_damping = 0.01; // one that needs more lies elsewhere
        // Other harmonics move the point a little. Farther, of the motion or of the window, is another
        // solution.
        constexpr double farthest = 0.3, farthest_in_frequency = 0.1;
        const PathState guess = path.at;
        const NewtonOutcome out = newton_across(*system_, metric, path.direction, limits, path.at);
        branch_.newton_work += out;
        const PathState moved = difference(path.at, guess);
        return out.converged && metric.length({moved.x, 0}) < farthest &&
               std::abs(moved.parameter) < farthest_in_frequency * metric.width;
    }

    const HbmOptions asked_;
    HbmOptions options_; // with the harmonics and the unknowns of now
    HbmOptions limits_;  // as asked, with the most harmonics that help
    std::shared_ptr<const ReducedModel> reduced_;
    MultipliersOf multipliers_;
    double omega_ = 0; // where the curve begins
    std::unique_ptr<HarmonicEquations> system_;
    bool compliant_ = false, modal_ = true, wants_modal_ = true;
    bool changes_ = false;  // the last step: other harmonics or unknowns are wanted
    bool rejects_ = false;  // the last step: its points have too few harmonics and are solved again with more
    bool has_side_ = false; // the curve leaves its first point to a side given
    std::int64_t n_kept_ = 1; // points up to the last step that was kept
    std::int64_t fewest_, wanted_harmonics_ = 0, since_change_ = 0, blocked_ = 0, moved_most_ = 0,
                          failed_growths_ = 0;
    double base_arclength_ = 0;
};

} // namespace

void trace_harmonic_curve(const HbmOptions &options, const CurveStart &start,
                          const MultipliersOf &multipliers, Watch watch, Branch &branch,
                          CurveRecorder *recorder) {
    HarmonicTracer(options, multipliers, watch, branch, recorder).trace(start);
}

} // namespace plm
