#include "searches/isolated.hpp"
#include "hbm/harmonic_choice.hpp"
#include "linalg/work.hpp"
#include "motions/branch_path.hpp"
#include "motions/compressed_motion.hpp"
#include "orbits/orbit_points.hpp"
#include "orbits/stationary_force.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/curve.hpp"
#include "searches/fold_tracking.hpp"
#include "searches/motion_choice.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t largest_system = 400; // unknowns of the backbone when harmonics are chosen by point
// Of the backbone and of the folds where harmonics are chosen; an exact motion that is not found from as many
// is looked for from twice and four times as many.
constexpr std::int64_t few_enough = 9;
constexpr int most_doublings = 2;
constexpr double weakest_resonance = 0.05; // of the main branch, against its largest response
// What a model that a loop is followed on leaves out of its first motion, if it needs more than the curve's.
constexpr double left_out_of_loop[] = {3e-5, 1e-5};
// Where the folds are followed: from the force by this on one side to the force times this on the other.
constexpr double aside = 2;
// Beyond a swallowtail: few leaps, each a small part of the force, as long as the folds go on as they went.
constexpr int most_leaps = 8;
constexpr double leap_lengths[] = {2e-3, 5e-3, 1e-2};
constexpr double straight_on = 5; // times the distance that the line through the last folds gives

// A crossing of the backbone with the force, and the extrema of the force (points of the backbone) between it
// and its neighbours: a loop exists from the minimum above its lower crossing to the maximum below it.
struct Seed {
    BranchPoint point;
    std::shared_ptr<const Branch> backbone;
    std::ptrdiff_t minimum = -1, maximum = -1;
    double reach = 0; // relative distance to the next crossing: the size of the loop
};

class Search {
  public:
    Search(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, const Branch &main,
           double force_max, Watch watch, std::shared_ptr<const ReducedModel> smaller)
        : reduced_(std::move(reduced)), smaller_(std::move(smaller)), options_(options), main_(main),
          watch_(watch), force_max_(force_max), resonance_(reduced_, backbone_options(), watch),
          exact_(reduced_->same_static && prefers_exact(*reduced_, options)) {}

    IsolatedSearch run() {
        const auto begin = std::chrono::steady_clock::now();
        if (options_.force_scale > 0) // else nothing moves
            within(effort_left(), [&] { search(); });
        out_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        return std::move(out_);
    }

  private:
    void search() {
        known_ = resonance_.on_curve(main_);
        out_.backbones = resonance_.backbones();
        add_backbones_of_main();
        std::vector<Seed> seeds;
        for (const Backbone &backbone : out_.backbones) collect(backbone, seeds);
        // from the largest response down: the top of a loop is its safest entry
        std::sort(seeds.begin(), seeds.end(),
                  [this](const Seed &a, const Seed &b) { return size_of(a.point) > size_of(b.point); });
        for (const Seed &seed : seeds)
            if (!is_known(seed.point)) trace(seed);
    }

    BackboneOptions backbone_options() const {
        BackboneOptions o;
        o.hbm = options_;
        o.force_max = force_max_;
        const std::int64_t first = with_first_harmonics(*reduced_, options_).n_harmonics;
        if (options_.n_harmonics > 0) return o;
        const std::int64_t room = largest_system / (2 * std::max<std::int64_t>(1, reduced_->size()));
        std::int64_t most = 0;
        for (const BranchPoint &p : main_.points())
            most = std::max(most, p.n_harmonics / options_.period_multiple);
        o.hbm.n_harmonics = std::max({first, few_enough, std::min(room, most)});
        return o;
    }

    double size_of(const BranchPoint &p) const { return norm2(p.eta.rows() * p.eta.cols(), p.eta.data()); }

    bool is_known(const BranchPoint &p) const {
        return std::any_of(known_.begin(), known_.end(),
                           [&](const BranchPoint &k) { return solution_distance(k, p) < same_response; });
    }

    // Resonances of the main branch that no backbone from rest has met.
    void add_backbones_of_main() {
        double largest = 0;
        for (const BranchPoint &p : main_.points()) largest = std::max(largest, size_of(p));
        for (const BranchPoint &p : known_) {
            if (size_of(p) < weakest_resonance * largest || met(p)) continue;
            out_.backbones.push_back(resonance_.through(p));
        }
    }

    bool met(const BranchPoint &p) const {
        for (const Backbone &b : out_.backbones)
            for (std::size_t i : b.crossings)
                if (solution_distance(b.branch->points()[i], p) < same_response) return true;
        return false;
    }

    void collect(const Backbone &backbone, std::vector<Seed> &seeds) const {
        const auto &points = backbone.branch->points();
        const auto &at = backbone.crossings;
        std::ptrdiff_t minimum = -1, maximum = -1;
        for (std::size_t k = 0; k < at.size(); ++k) {
            if (k > 0) {
                const std::ptrdiff_t i = extremum(points, at[k - 1], at[k]);
                const bool over = i >= 0 && points[i].force_scale > options_.force_scale;
                (over ? maximum : minimum) = i;
                if (over && k + 1 < at.size()) minimum = extremum(points, at[k], at[k + 1]);
            }
            Seed seed{points[at[k]], backbone.branch, minimum, maximum};
            if (!resonance_.correct(options_.force_scale, seed.point)) continue;
            if (std::any_of(seeds.begin(), seeds.end(), [&](const Seed &s) {
                    return solution_distance(s.point, seed.point) < same_response;
                }))
                continue;
            for (std::size_t other : at) {
                const double d = solution_distance(points[other], points[at[k]]);
                if (other != at[k] && (seed.reach == 0 || d < seed.reach)) seed.reach = d;
            }
            seeds.push_back(std::move(seed));
        }
    }

    // The point furthest from the force asked for between two crossings.
    std::ptrdiff_t extremum(const std::vector<BranchPoint> &points, std::size_t from, std::size_t to) const {
        std::ptrdiff_t best = -1;
        double most = 0;
        for (std::size_t i = from + 1; i < to; ++i) {
            const double d = std::abs(points[i].force_scale - options_.force_scale);
            if (d > most) most = d, best = static_cast<std::ptrdiff_t>(i);
        }
        return best;
    }

    // A seed as a point of the curve asked for: the exact motion beside it, or, where none is found,
    // settled harmonics. False: it vanishes with more harmonics, or becomes a point of a known branch.
    bool enter(const HbmOptions &options, BranchPoint &start) const {
        BackboneOptions o = backbone_options();
        BranchPoint near = start;
        for (int doublings = 0; exact_ && doublings <= most_doublings; ++doublings) {
            NewtonWork work;
            if (make_exact_nearest(reduced_, options, near, work)) {
                start = near;
                return true;
            }
            o.hbm.n_harmonics *= 2;
            set_harmonics(near.eta, o.hbm.n_harmonics * options.period_multiple);
            near.n_harmonics = near.eta.cols() / 2;
            if (!PhaseResonance(reduced_, o, watch_).correct(options.force_scale, near) || is_known(near))
                return false;
        }
        settle_harmonics(reduced_, options, start, watch_);
        return true;
    }

    // The compressed model, or one that has what it lacks of this motion, too, which becomes the motion
    // there; the basis itself, where none is right and smaller.
    std::shared_ptr<const ReducedModel> model_for(BranchPoint &start) const {
        auto model = start.motion ? smaller_ : nullptr;
        for (auto left_out = std::begin(left_out_of_loop);; ++left_out) {
            if (!model || !is_much_smaller(*model, *reduced_)) return reduced_;
            if (on_model(model, start)) return model;
            if (left_out == std::end(left_out_of_loop)) return reduced_;
            model = compressed_with(*smaller_, start, 2 * M_PI * options_.frequency_max_hz, *left_out);
        }
    }

    // False: it is another one there, or is not found.
    bool on_model(const std::shared_ptr<const ReducedModel> &model, BranchPoint &start) const {
        BranchPoint there;
        NewtonWork work;
        if (!compress(*model, start, there) ||
            !make_exact_nearest(model, options_on(*model, options_), there, work))
            return false;
        const double distance = solution_distance(uncompressed(*model, there), start);
        watch_.log(1,
                   format("an isolated motion is off by %.2g of itself on %lld of %lld coordinates", distance,
                          static_cast<long long>(model->size()), static_cast<long long>(reduced_->size())));
        if (!(distance <= compression_tolerance(*reduced_, options_))) return false;
        start = std::move(there);
        return true;
    }

    void trace(const Seed &seed) {
        const HbmOptions options = for_a_loop(options_, seed.reach);
        BranchPoint start = seed.point;
        if (!enter(options, start)) return;
        IsolatedBranch found;
        const auto model = model_for(start);
        found.branch = trace_through(model, options_on(*model, options), start, watch_);
        found.closed = found.branch->end_reason == reason::loop_closed;
        const std::vector<BranchPoint> met =
            resonance_.on_curve(*on_whole_basis(*found.branch, options_, 0, -1));
        for (const BranchPoint &p : met)
            if (p.omega != seed.point.omega && is_known(p)) return; // the main branch, or one found already
        known_.push_back(seed.point);
        known_.insert(known_.end(), met.begin(), met.end());
        find_range(seed, found);
        out_.branches.push_back(std::move(found));
    }

    // Births and mergers are extrema of the force along the curve of folds, next to those of the backbone.
    void find_range(const Seed &seed, IsolatedBranch &found) const {
        const bool birth = find_end(seed, seed.minimum, false, found, found.birth_force),
                   merge = find_end(seed, seed.maximum, true, found, found.merge_force);
        found.tracked = birth && merge;
    }

    // Directly, from the backbone's extremum; along the folds where that leads nowhere.
    bool find_end(const Seed &seed, std::ptrdiff_t at, bool upward, const IsolatedBranch &found,
                  double &force) const {
        force = NAN;
        if (at < 0) return false;
        const BranchPoint &extremum = seed.backbone->points()[at];
        if (found.branch->points().front().motion) {
            force = stationary_force(reduced_, options_, extremum,
                                     upward ? ForceExtremum::saddle : ForceExtremum::centre, watch_);
            if (is_of(force, extremum) && (force > options_.force_scale) == upward) return true;
            force = NAN;
        } else { // with the few harmonics of its backbone it says nothing of exact motions
            force = extremum.force_scale;
        }
        return follow_to_end(extremum, upward, *found.branch, force);
    }

    // From the fold nearest to the backbone's extremum; the others when that leads elsewhere.
    bool follow_to_end(const BranchPoint &extremum, bool upward, const Branch &loop, double &force) const {
        std::vector<BranchPoint> folds;
        for (std::size_t i = 0; i < loop.points().size(); ++i) {
            const auto at = static_cast<std::int64_t>(i);
            if (loop.points()[i].bifurcation == bifurcation::fold)
                folds.push_back(on_whole_basis(loop, options_, at, at)->points()[i]);
        }
        std::sort(folds.begin(), folds.end(), [&](const BranchPoint &a, const BranchPoint &b) {
            return std::abs(a.omega - extremum.omega) < std::abs(b.omega - extremum.omega);
        });
        vector<double> turns;
        for (const BranchPoint &fold : folds) {
            const double turn = first_turn(fold, upward, extremum.force_scale);
            const auto is_this = [turn](double t) { return std::abs(t / turn - 1) < same_response; };
            if (is_of(turn, extremum) || std::any_of(turns.begin(), turns.end(), is_this)) {
                force = turn;
                return true;
            }
            turns.push_back(turn);
        }
        return false;
    }

    // Where the folds turn back in the force for good. Near grazing contact the curve of folds has a small
    // swallowtail, or a corner that no step passes; beyond it the folds go on.
    double first_turn(const BranchPoint &fold, bool upward, double estimate) const {
        FoldOptions o;
        o.hbm = options_;
        o.force_min = (upward ? options_.force_scale : estimate) / aside;
        o.force_max = aside * (upward ? estimate : options_.force_scale);
        o.upward = upward;
        o.stop_at_turn = true;
        double turn = NAN;
        BranchPoint from = fold;
        for (int leaps = 0; leaps < most_leaps; ++leaps) {
            const auto folds = follow_folds(reduced_, o, from, watch_);
            if (!folds) break;
            require_unstopped(*folds);
            if (folds->end_reason == reason::range_end) break;
            const auto &points = folds->points();
            std::size_t last = 0;
            while (last + 1 < points.size() && points[last].bifurcation != bifurcation::fold) ++last;
            if (points[last].bifurcation == bifurcation::fold) turn = points[last].force_scale;
            if (!leap(points, last, upward, from)) break;
        }
        return turn;
    }

    // A fold a little beyond points[last], on the line through two points before it.
    bool leap(const std::vector<BranchPoint> &points, std::size_t last, bool upward,
              BranchPoint &beyond) const {
        if (last < 2) return false;
        const BranchPoint &near = points[last - 1], &far = points[last - 2];
        const double run = near.force_scale - far.force_scale, apart = solution_distance(near, far);
        if (run == 0) return false;
        for (double step : leap_lengths) {
            const double force = points[last].force_scale * (upward ? 1 + step : 1 - step),
                         t = (force - near.force_scale) / run;
            BranchPoint guess = between(near, far, -t);
            if (!correct_fold(reduced_, options_, force, near, guess)) continue;
            if (solution_distance(guess, near) > straight_on * std::abs(t) * apart) continue;
            guess.force_scale = force;
            beyond = guess;
            return true;
        }
        return false;
    }

    std::shared_ptr<const ReducedModel> reduced_, smaller_; // smaller_: compressed, or null
    HbmOptions options_;
    const Branch &main_;
    Watch watch_;
    double force_max_;
    PhaseResonance resonance_;
    bool exact_;                     // loops of exact motions
    std::vector<BranchPoint> known_; // phase-resonant points of the branches known
    IsolatedSearch out_;
};

} // namespace

std::shared_ptr<Branch> trace_through(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                                      const BranchPoint &start, Watch watch) {
    HbmOptions o = options;
    o.upward = true;
    const auto after = std::make_shared<Branch>(reduced, o.force_scale, o.period_multiple);
    trace_curve(o, {start, {}}, watch, *after);
    require_unstopped(*after);
    if (after->end_reason == reason::loop_closed) return after;
    o.upward = false;
    Branch before(reduced, o.force_scale, o.period_multiple);
    trace_curve(o, {start, {}}, watch, before);
    require_unstopped(before);
    const auto whole = joined(before, *after);
    for (const Warnings *said : {&before.warnings, &after->warnings})
        for (const Warning &w : said->list()) // of harmonics the whole has its own
            if (w.reason != reason::harmonics_too_few) whole->warnings.add(w.reason, w.text);
    warn_of_harmonics(options, *whole);
    return whole;
}

HbmOptions for_a_loop(HbmOptions options, double reach) {
    constexpr double of_the_loop = 0.3, // largest step
        at_first = 0.1;                 // of that: its top is where it bends most
    if (reach > 0)
        options.max_step = std::max(10 * options.min_step, std::min(options.max_step, of_the_loop * reach));
    options.initial_step = at_first * options.max_step;
    return options;
}

IsolatedSearch find_isolated(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                             const Branch &main, double force_max, Watch watch,
                             std::shared_ptr<const ReducedModel> smaller) {
    return Search(std::move(reduced), options, main, force_max, watch, std::move(smaller)).run();
}

} // namespace plm
