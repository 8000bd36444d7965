#include "searches/larger_motion.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "motions/compressed_motion.hpp"
#include "motions/curve_verdicts.hpp"
#include "motions/effort_budget.hpp"
#include "orbits/orbit_cost.hpp"
#include "orbits/orbit_points.hpp"
#include "orbits/stationary_force.hpp"
#include "reduction/compression.hpp"
#include "reduction/reduced_rest.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/isolated.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Less is hardly worth a word, and no more than what the two may be off by.
constexpr double clearly = 0.01;
constexpr std::int64_t least_points = 20; // fewer lead nowhere
// Of a backbone, which only shows where the force of the curve is met again: what is met is made exact.
constexpr double tolerance_on_the_way = 1e-6;
constexpr std::size_t most_looked_at = 2; // resonances of the curve, and crossings of a backbone

// A crossing of a backbone with the force of the curve.
struct Crossing {
    BranchPoint point;
    double amplitude, reach;             // reach: distance to the next one
    const BranchPoint *lowest, *highest; // extrema of the force beside it; null: not known
};

class SearchBeside {
  public:
    SearchBeside(const KnownResponse &known, Watch watch, std::optional<LargerMotion> &best)
        : known_(known), curve_(*known.curve), reduced_(curve_.reduced_model()), watch_(watch),
          options_(options_on(*reduced_, known.options)), exact_(is_exact()), best_(best) {
        take_range();
        points_ = affordable_points();
        options_.max_points = points_;
    }

    void run(const std::vector<IsolatedBranch> *found) {
        if (curve_.beside) take(curve_.beside);
        if (found) {
            for (const IsolatedBranch &b : *found)
                if (take(b.branch)) best_->force_low = b.birth_force, best_->force_high = b.merge_force;
            return;
        }
        if (points_ < least_points || !is_held_apart()) return;
        if (reduced_->whole_contact().moves()) return; // the phase against the force is none of resonance
        std::vector<BranchPoint> starts =
            PhaseResonance(reduced_, backbone_options(points_), watch_.quiet()).on_curve(curve_);
        std::sort(starts.begin(), starts.end(),
                  [this](const BranchPoint &a, const BranchPoint &b) { return amplitude(a) > amplitude(b); });
        std::int64_t left = points_;
        for (std::size_t i = 0; i < std::min(starts.size(), most_looked_at) && left >= least_points; ++i)
            left -= look_beyond(starts[i], left);
    }

  private:
    bool is_exact() const {
        return reduced_->same_static && !curve_.points().empty() && curve_.points().front().motion;
    }

    // As far as the sweep might have gone.
    void take_range() {
        const SweepRange window = known_.basis->sweep_range();
        double low = INFINITY, high = 0;
        for (const BranchPoint &p : curve_.points()) {
            low = std::min(low, p.omega / (2 * M_PI));
            high = std::max(high, p.omega / (2 * M_PI));
        }
        options_.frequency_min_hz = window.least_hz > 0 ? std::min(low, window.least_hz) : low;
        options_.frequency_max_hz = std::max(high, window.most_hz);
    }

    std::int64_t affordable_points() const {
        const std::int64_t h =
            with_first_harmonics(*reduced_, options_).n_harmonics * options_.period_multiple;
        const double step = exact_ ? exact_step_flops(*reduced_, options_)
                                   : harmonic_step_flops(*reduced_, curve_.n_harmonics()),
                     of_backbone = exact_ ? step : harmonic_step_flops(*reduced_, h),
                     point = EffortBudget::steps_of_backbone_point * of_backbone,
                     allowed = std::max(EffortBudget::aside,
                                        step * static_cast<double>(curve_.newton_work.iterations));
        return static_cast<std::int64_t>(std::min(allowed / point, static_cast<double>(options_.max_points)));
    }

    BackboneOptions backbone_options(std::int64_t points) const {
        BackboneOptions o;
        o.hbm = exact_ ? options_ : with_first_harmonics(*reduced_, options_);
        o.hbm.max_points = points;
        o.hbm.tolerance = std::max(o.hbm.tolerance, tolerance_on_the_way);
        o.exact = exact_;
        o.only_special = true;
        return o;
    }

    // Where pairs neither touch with pressure nor gap, the force changes nothing but the size.
    bool is_held_apart() const {
        const vector<double> coupling = coupling_at_rest(*reduced_);
        return std::any_of(coupling.begin(), coupling.end(), [](double c) { return c != 0.5; });
    }

    double amplitude(const BranchPoint &point) const {
        Branch one(reduced_, curve_.force_scale(), curve_.period_multiple());
        one.append(point);
        return amplitude(one, 0);
    }
    double amplitude(const Branch &branch, std::int64_t point) const {
        return branch.amplitude(point, known_.output.dof, known_.output.measure, known_.output.harmonic);
    }
    bool is_larger(double amplitude) const {
        return amplitude > (1 + clearly) * std::max(known_.amplitude, best_ ? best_->amplitude : 0.0);
    }

    // Returns the points that it took.
    std::int64_t look_beyond(const BranchPoint &start, std::int64_t most_points) {
        const PhaseResonance resonance(reduced_, backbone_options(most_points), watch_.quiet());
        const Backbone backbone = resonance.onward(start);
        std::vector<Crossing> found = crossings(resonance, start, backbone);
        std::sort(found.begin(), found.end(),
                  [](const Crossing &a, const Crossing &b) { return a.amplitude > b.amplitude; });
        found.resize(std::min(found.size(), most_looked_at));
        for (const Crossing &crossing : found)
            if (is_larger(crossing.amplitude)) follow(crossing);
        return backbone.n_passed;
    }

    // All but the start. A loop lies between a maximum of the force, where it merges, and the minimum beyond.
    std::vector<Crossing> crossings(const PhaseResonance &resonance, const BranchPoint &start,
                                    const Backbone &backbone) const {
        const auto &points = backbone.branch->points();
        std::vector<std::size_t> at = {0};
        std::vector<const BranchPoint *> extremum = {nullptr}; // before each
        std::vector<Crossing> found;
        for (std::size_t i : backbone.crossings) {
            BranchPoint point = points[i];
            if (!resonance.correct(curve_.force_scale(), point) ||
                solution_distance(point, start) < same_response)
                continue;
            extremum.push_back(farthest(points, at.back(), i));
            const double reach = solution_distance(points[at.back()], point), size = amplitude(point);
            if (!found.empty()) found.back().reach = std::min(found.back().reach, reach);
            found.push_back({std::move(point), size, reach, nullptr, nullptr});
            at.push_back(i);
        }
        extremum.push_back(nullptr);
        for (std::size_t k = 1; k <= found.size(); ++k) {
            const bool over = extremum[k] && extremum[k]->force_scale > curve_.force_scale();
            found[k - 1].highest = over ? extremum[k] : extremum[k - 1];
            found[k - 1].lowest = over ? extremum[k + 1] : extremum[k];
        }
        return found;
    }

    // The point between two crossings whose force is farthest from that of the curve.
    const BranchPoint *farthest(const std::vector<BranchPoint> &points, std::size_t from,
                                std::size_t to) const {
        const BranchPoint *found = nullptr;
        double most = 0;
        for (std::size_t i = from + 1; i < to; ++i) {
            const double far = std::abs(points[i].force_scale - curve_.force_scale());
            if (far > most) most = far, found = &points[i];
        }
        return found;
    }

    void follow(const Crossing &crossing) {
        const HbmOptions o = for_a_loop(options_, crossing.reach);
        BranchPoint start = crossing.point;
        NewtonWork work;
        if (!exact_)
            settle_harmonics(reduced_, o, start, watch_.quiet());
        else if (!make_exact_nearest(reduced_, o, start, work))
            return;
        if (!take(trace_through(reduced_, o, start, watch_.quiet()))) return;
        best_->force_low = force_at(crossing.lowest, ForceExtremum::centre);
        best_->force_high = force_at(crossing.highest, ForceExtremum::saddle);
    }

    // The highest stable motion of a curve as the best so far, if it is that.
    bool take(const std::shared_ptr<const Branch> &curve) {
        const Output &of = known_.output;
        const std::int64_t top = highest_stable(*curve, of);
        if (top < 0 || !is_larger(amplitude(*curve, top))) return false;
        LargerMotion m = {0, amplitude(*curve, top), curve, NAN, NAN};
        BranchPoint point = curve->points()[static_cast<std::size_t>(top)];
        const Peak peak = Hbm(known_.basis, known_.options, watch_.quiet())
                              .find_peak(*curve, of.dof, of.measure, of.harmonic);
        if (peak.branch->warnings.has(reason::no_contraction)) return false; // it need not be near a solution
        if (stability_of(peak.branch->points()[0]) == 1) {
            m.amplitude = peak.amplitude;
            point = peak.branch->points()[0];
        }
        m.frequency_hz = point.omega / (2 * M_PI);
        if (!is_on_basis(curve->reduced_model(), point, m.amplitude)) return false;
        best_ = std::move(m);
        return true;
    }

    // Whether the basis has a stable motion of a compressed model, too.
    bool is_on_basis(const std::shared_ptr<const ReducedModel> &model, const BranchPoint &point,
                     double height) const {
        if (!model->from) return true;
        const auto whole = uncompressed(model);
        BranchPoint there = uncompressed(*model, point);
        NewtonWork work;
        if (!make_exact_nearest(whole, options_, there, work) || stability_of(there) != 1) return false;
        Branch one(whole, curve_.force_scale(), curve_.period_multiple());
        one.append(std::move(there));
        return std::abs(amplitude(one, 0) / height - 1) <= same_motion;
    }

    double force_at(const BranchPoint *extremum, ForceExtremum kind) const {
        if (!extremum) return NAN;
        const double near = extremum->force_scale,
                     exact = exact_ ? stationary_force(reduced_, options_, *extremum, kind, watch_.quiet())
                                    : near;
        return is_of(exact, *extremum) ? exact : near;
    }

    const KnownResponse &known_;
    const Branch &curve_;
    std::shared_ptr<const ReducedModel> reduced_;
    Watch watch_;
    HbmOptions options_;
    bool exact_;
    std::int64_t points_ = 0;
    std::optional<LargerMotion> &best_;
};

} // namespace

std::optional<LargerMotion> find_larger_motion(const KnownResponse &known, Watch watch,
                                               const std::vector<IsolatedBranch> *found) {
    std::optional<LargerMotion> best;
    try {
        SearchBeside(known, watch, best).run(found);
    } catch (const Error &e) { // what there is already is an answer
        if (e.status() == status::cancelled || e.status() == status::memory) throw;
        watch.log(1, std::string("the search beside the curve ended early: ") + e.what());
    }
    return best;
}

std::string words_for(const LargerMotion &larger, const KnownResponse &known) {
    const auto end = [](const char *side, double force) {
        return std::isnan(force) ? std::string() : format(" %s %.4g", side, force);
    };
    const std::string range = end("from", larger.force_low) + end("to", larger.force_high);
    return format(
        "beside the curve, at the same force, there is a stable motion of %.6g at %.6g Hz, %.3g times the "
        "peak: a slow sweep does not come to it, but a disturbance, a start at large motion or a force that "
        "was larger before may leave the structure there. Its own curve%s is what the solver of this call "
        "has found (\"n_found\", \"larger_amplitude\")",
        larger.amplitude, larger.frequency_hz, larger.amplitude / known.amplitude,
        range.empty() ? "" : (", for force scales" + range + ",").c_str());
}

} // namespace plm
