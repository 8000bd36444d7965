// The highest point of a curve, found on the curve itself: points on hyperplanes across the chord through the
// three highest ones, by successive parabolic interpolation.
#include "hbm/harmonic_choice.hpp"
#include "linalg/work.hpp"
#include "motions/branch_path.hpp"
#include "motions/curve_verdicts.hpp"
#include "searches/basis_error.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/curve.hpp"
#include "searches/hbm.hpp"
#include "searches/point_equations.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace plm {
namespace {

constexpr double least_tolerance = 1e-12; // rounding of a period of the flow

struct Sample {
    double s = 0; // position along the chord
    PathState at;
    double amplitude = 0;
    BranchPoint point;
};

class PeakSearch {
  public:
    PeakSearch(PeriodicEquations &equations, const HbmOptions &options,
               std::shared_ptr<const ReducedModel> reduced, std::int64_t dof, Measure measure,
               std::int64_t harmonic, Watch watch)
        : equations_(equations), options_(options), reduced_(std::move(reduced)), dof_(dof),
          measure_(measure), harmonic_(harmonic), watch_(watch) {}

    /// False: the highest point of the curve is no solution with this system's harmonics, nor near one.
    bool run(const Branch &branch, const std::array<std::int64_t, 3> &around, BranchPoint &highest) {
        for (int k = 0; k < 3; ++k) load(branch, around[k], three_[k]);
        set_chord();
        above_ = rise(); // until it is looked for more closely
        if (!is_exact() && !solve_triple()) return false;
        const bool settled = close_in();
        const Sample &top = *std::max_element(three_.begin(), three_.end(), [](const auto &a, const auto &b) {
            return a.amplitude < b.amplitude;
        });
        constexpr double same_height = 1e-9; // rounding decides between them
        Sample best;
        above_ = settled ? 0 : rise();
        if (!corrected(vertex(), best) || best.amplitude < top.amplitude * (1 - same_height)) best = top;
        above_ = std::max(0.0, above_ - (best.amplitude / top.amplitude - 1));
        highest = std::move(best.point);
        return true;
    }

    /// By how much the peak may be higher than the point found, of that: 0 where it was closed in upon. The
    /// parabola may miss a sharp top by as much as it rises.
    double above() const { return 2 * above_; }

  private:
    bool is_exact() const {
        return std::all_of(three_.begin(), three_.end(), [](const Sample &s) { return s.point.motion; });
    }

    // The curve's points may have other numbers of harmonics; a parabola through both kinds has no meaning.
    bool solve_triple() {
        Sample solved, left, right;
        if (!corrected(three_[1].s, solved)) return false;
        const bool all = corrected(three_[0].s, left) && corrected(three_[2].s, right);
        three_[1] = solved;
        if (all) three_[0] = left, three_[2] = right;
        return true;
    }

    // New triples around the vertex, ten times closer as long as the top is inside: the error of a parabola
    // falls with its square. One that misses the top (far from it the curve is no parabola) goes to its
    // higher side with wider steps.
    bool close_in() {
        // Closer, differences of amplitudes drown in the error of their solutions, which corrected() keeps
        // small; and where contact forces come from samples, in the jumps as a pair switches past one.
        constexpr double usual = 1e-9, close = 2e-3; // the height of a parabola goes with the square
        const double closest =
                         (options_.aft == AftKind::sampled
                              ? 5e-2
                              : std::clamp(close * std::sqrt(options_.tolerance / usual), close, 5e-2)) *
                         span_,
                     widest = 0.25 * span_;
        constexpr int most_rounds = 20; // three when the top is inside from the beginning
        double reach = 0.05 * span_;
        for (int round = 0; round < most_rounds; ++round) {
            Sample left, middle, right;
            if (!corrected(vertex(), middle) || !corrected(middle.s - reach, left) ||
                !corrected(middle.s + reach, right))
                return false;
            three_ = {left, middle, right};
            const bool inside = left.amplitude < middle.amplitude && right.amplitude < middle.amplitude;
            if (inside && reach <= closest) return true;
            reach = inside ? std::max(0.1 * reach, closest) : std::min(2 * reach, widest);
        }
        return false;
    }

    // Of the parabola above the highest of the three, relative.
    double rise() const {
        const double s = vertex();
        double height = 0, top = 0;
        for (int k = 0; k < 3; ++k) {
            const Sample &a = three_[k], &b = three_[(k + 1) % 3], &c = three_[(k + 2) % 3];
            height += a.amplitude * (s - b.s) * (s - c.s) / ((a.s - b.s) * (a.s - c.s));
            top = std::max(top, a.amplitude);
        }
        return top > 0 ? std::max(0.0, height / top - 1) : 0;
    }

    void load(const Branch &branch, std::int64_t i, Sample &s) {
        s.point = branch.points()[i];
        s.at = {equations_.unknowns(s.point), s.point.omega};
        s.amplitude = branch.amplitude(i, dof_, measure_, harmonic_);
    }

    void set_chord() {
        const double size = norm2(equations_.size(), three_[1].at.x.data());
        metric_ = {size > 0 ? size : 1, 2 * M_PI * (options_.frequency_max_hz - options_.frequency_min_hz)};
        chord_ = difference(three_[2].at, three_[0].at);
        scale_by(1 / metric_.length(chord_), chord_);
        origin_ = three_[1].at;
        for (Sample &s : three_) s.s = metric_.product(chord_, difference(s.at, origin_));
        first_ = three_[0].s, last_ = three_[2].s;
        span_ = last_ - first_;
    }

    // Vertex of the parabola through the triple, kept inside it and inside the first one.
    double vertex() const {
        const Sample &a = three_[0], &b = three_[1], &c = three_[2];
        const double left = (b.amplitude - a.amplitude) / (b.s - a.s),
                     right = (c.amplitude - b.amplitude) / (c.s - b.s);
        const double bend = (right - left) / (c.s - a.s);
        double s = 0.5 * (a.s + b.s) - 0.5 * left / bend;
        if (!(bend < 0))
            s = std::max({a.amplitude, b.amplitude, c.amplitude}) == b.amplitude ? b.s
                : a.amplitude > c.amplitude                                      ? a.s
                                                                                 : c.s;
        return std::clamp(s, std::max(a.s, first_), std::min(c.s, last_));
    }

    // The curve's point in the hyperplane at s, from the parabola through the triple as first guess.
    bool corrected(double s, Sample &out) {
        watch_.step("peak", 0.5);
        const Sample &a = three_[0], &b = three_[1], &c = three_[2];
        const double la = (s - b.s) * (s - c.s) / ((a.s - b.s) * (a.s - c.s)),
                     lb = (s - a.s) * (s - c.s) / ((b.s - a.s) * (b.s - c.s)),
                     lc = (s - a.s) * (s - b.s) / ((c.s - a.s) * (c.s - b.s));
        out.at = a.at;
        scale_by(la, out.at);
        add(lb, b.at, out.at);
        add(lc, c.at, out.at);
        NewtonLimits limits = newton_limits(options_);
        limits.aim = std::max(1e-3 * limits.tolerance, least_tolerance); // for small differences
        const NewtonOutcome found = newton_across(equations_, metric_, chord_, limits, out.at);
        if (!found.converged) return false;
        out.s = s;
        out.point = equations_.solved_point(out.at, found.residual, found.iterations);
        Branch one(reduced_, options_.force_scale, options_.period_multiple);
        one.append(out.point);
        out.amplitude = one.amplitude(0, dof_, measure_, harmonic_);
        return true;
    }

    PeriodicEquations &equations_;
    const HbmOptions &options_;
    std::shared_ptr<const ReducedModel> reduced_;
    std::int64_t dof_;
    Measure measure_;
    std::int64_t harmonic_;
    Watch watch_;
    std::array<Sample, 3> three_;
    Metric metric_;
    PathState origin_, chord_; // the latter of length 1
    double first_ = 0, last_ = 1, span_ = 1, above_ = 0;
};

// The peak beside the highest point of a curve, as near as its harmonics and the effort allow.
class CloserLook {
  public:
    CloserLook(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &of_curve, const Branch &branch,
               const std::array<std::int64_t, 3> &around, const Output &of, Watch watch)
        : reduced_(std::move(reduced)), options_(options_on(*reduced_, of_curve)), branch_(branch),
          around_(around), of_(of), watch_(watch), point_(branch.points()[around[1]]),
          most_harmonics_(with_affordable_harmonics(*reduced_, of_curve).max_harmonics),
          automatic_(of_curve.n_harmonics == 0 && !point_.motion) {
        options_.force_scale = point_.force_scale;
        options_.period_multiple = branch.period_multiple();
        options_.n_harmonics = harmonics_of(point_, options_.period_multiple);
        error_ = point_.motion ? 0 : point_.harmonic_error;
    }

    // Where harmonics are chosen, an order better than on the curve: one point is cheap, and its amplitude is
    // what people quote.
    void close_in() {
        const double wanted = 0.1 * options_.allowed_harmonic_error();
        if (automatic_) error_ = error_here();
        do {
            if (error_ > wanted)
                options_.n_harmonics =
                    std::max(options_.n_harmonics, std::min(most_harmonics_, 2 * options_.n_harmonics));
            equations_ = equations_of(reduced_, options_, point_, StabilityOf::point);
            search_ = std::make_unique<PeakSearch>(*equations_, options_, reduced_, of_.dof, of_.measure,
                                                   of_.harmonic, watch_);
            search_->run(branch_, around_, point_);
            if (automatic_) error_ = error_here();
        } while (error_ > wanted && options_.n_harmonics < most_harmonics_);
    }

    void find_multipliers() {
        if (equations_) point_.multipliers = multipliers_at(*equations_, point_);
    }

    const BranchPoint &point() const { return point_; }
    double harmonic_error() const { return error_; }
    /// As PeakSearch; where none was begun, by how much the lower neighbour is lower: a parabola rises less.
    double above() const {
        if (search_) return search_->above();
        const auto height = [&](int k) {
            return branch_.amplitude(around_[k], of_.dof, of_.measure, of_.harmonic);
        };
        return 1 - std::min(height(0), height(2)) / height(1);
    }

  private:
    // At the DOF, which need not be that of the motion as a whole.
    double error_here() {
        const MeasuredHarmonics next = measure_harmonics(reduced_, options_, point_);
        return harmonic_error_at(*reduced_, point_, next.change, of_.dof, of_.measure, of_.harmonic);
    }

    std::shared_ptr<const ReducedModel> reduced_;
    HbmOptions options_;
    const Branch &branch_;
    std::array<std::int64_t, 3> around_;
    Output of_;
    Watch watch_;
    BranchPoint point_;
    std::int64_t most_harmonics_;
    bool automatic_; // harmonics are chosen
    double error_ = 0;
    std::unique_ptr<PeriodicEquations> equations_;
    std::unique_ptr<PeakSearch> search_;
};

// The highest point and its neighbours; a closed curve, whose last point is its first, has no ends. False:
// the highest point stands at an end.
bool neighbours(const Branch &branch, std::int64_t top, std::array<std::int64_t, 3> &around) {
    const std::int64_t n = static_cast<std::int64_t>(branch.points().size());
    const bool inner = top > 0 && top < n - 1;
    around =
        inner ? std::array<std::int64_t, 3>{top - 1, top, top + 1} : std::array<std::int64_t, 3>{n - 2, 0, 1};
    return inner || (branch.end_reason == PLM_REASON_LOOP_CLOSED && n > 3);
}

// What rounding leaves of a DOF that does not move, of the largest one: its amplitude says nothing.
bool moves(const Branch &branch, std::int64_t top, double amplitude) {
    constexpr double rounding = 1e-12;
    const ReducedModel &m = branch.reduced();
    const BranchPoint &p = branch.points()[static_cast<std::size_t>(top)];
    if (amplitude == 0 || !m.model || p.eta.cols() < 2) return amplitude != 0;
    return amplitude > rounding * largest_entry(combine(m.vectors, p.eta.columns(0, 2))).size;
}

// ", ...": what a curve that is highest at its end has of peaks inside.
std::string highest_inside(const Branch &branch, const Output &of) {
    const auto height = [&](std::size_t i) {
        return branch.amplitude(static_cast<std::int64_t>(i), of.dof, of.measure, of.harmonic);
    };
    std::size_t best = 0;
    for (std::size_t i = 1; i + 1 < branch.points().size(); ++i)
        if (height(i) > height(i - 1) && height(i) >= height(i + 1) &&
            (best == 0 || height(i) > height(best)))
            best = i;
    if (best == 0) return "";
    return format(". Inside the curve the highest peak is about %.4g, at %.6g Hz", height(best),
                  branch.points()[best].omega / (2 * M_PI));
}

// Towards 0 Hz what nothing holds moves as a whole, by more and more.
bool is_motion_as_a_whole(const Branch &branch, std::int64_t top) {
    const auto &points = branch.points();
    const Model *model = branch.reduced().model.get();
    const double omega = points[static_cast<std::size_t>(top)].omega;
    return model && model->n_unheld() > 0 && omega < std::max(points.front().omega, points.back().omega);
}

std::string why_no_peak(const Branch &branch, std::int64_t top, bool of_motion, const Output &of) {
    const std::int64_t n = static_cast<std::int64_t>(branch.points().size());
    const double hz = branch.points()[static_cast<std::size_t>(top)].omega / (2 * M_PI);
    if (!of_motion)
        return "this DOF does not move on the curve (in this measure), as one that is fixed, or at a node of "
               "the motion: it has no peak. Ask for a DOF that moves";
    if (n == 1) return format("the curve is a single point, %.6g Hz: its amplitude is no peak", hz);
    if (top > 0 && branch.end_reason != PLM_REASON_RANGE_END)
        return format(
            "the highest point, %.6g Hz, is where the curve ended early (%s): no peak is known to be "
            "there",
            hz, end_text(branch.end_reason).c_str());
    if (is_motion_as_a_whole(branch, top))
        return format(
                   "the highest point stands at the lower end of the curve, %.6g Hz, where the structure, "
                   "which nothing holds, moves as a whole: by more the lower the frequency, without a peak. "
                   "Follow the curve over the resonance that is meant (frequency_min_hz, "
                   "frequency_max_hz), or ask for a DOF that moves less as a whole",
                   hz) +
               highest_inside(branch, of);
    return format("the highest point stands at an end of the curve, %.6g Hz: the peak lies beyond it. Follow "
                  "the "
                  "curve over a wider range (frequency_min_hz, frequency_max_hz)",
                  hz) +
           highest_inside(branch, of);
}

} // namespace

Peak Hbm::find_peak(const Branch &branch, std::int64_t dof, Measure measure, std::int64_t harmonic) const {
    const std::shared_ptr<const ReducedModel> reduced = model_of(branch, "branch");
    const std::int64_t top = branch.highest_point(dof, measure, harmonic);
    const double highest = branch.amplitude(top, dof, measure, harmonic);
    std::array<std::int64_t, 3> around;
    const bool of_motion = moves(branch, top, highest),
               is_peak = neighbours(branch, top, around) && of_motion;
    Peak peak;
    auto one = std::make_shared<Branch>(reduced, branch.force_scale(), branch.period_multiple());
    one->end_reason = PLM_REASON_RANGE_END;
    BranchPoint point = branch.points()[top];
    const HbmOptions limits = with_affordable_harmonics(*reduced, options_);
    const Output of{dof, measure, harmonic};
    double error = point.motion ? 0 : point.harmonic_error; // an exact motion lacks no harmonics
    if (is_peak) {
        const double of_peak = 0.7; // of the effort: the rest is for the estimate of its error
        CloserLook look(reduced, options_, branch, around, of, watch_);
        within(of_peak * effort_left(), [&] { look.close_in(); });
        const bool in_time = within(of_peak * effort_left(), [&] { look.find_multipliers(); });
        const double multiplier_error = point.multiplier_error;
        point = look.point();
        point.multiplier_error = multiplier_error;
        error = look.harmonic_error();
        peak.above = look.above();
        if (options_.stability != StabilityKind::off && point.multipliers.empty())
            one->warnings.add(PLM_REASON_UNVERIFIED,
                              in_time ? Stability(reduced, options_, StabilityOf::point).unknown_text(1, 1)
                                      : "the stability of the peak is not known: the effort allowed was "
                                        "spent before; raise the effort of the context");
    } else { // it stays where it is
        watch_.keeping(one->warnings).warn(PLM_REASON_NO_PEAK, why_no_peak(branch, top, of_motion, of));
    }
    one->append(point);
    vector<std::complex<double>> of_structure;
    const double by_basis =
        of_motion ? basis_error_at(made_as_, options_, *one, 0, of,
                                   std::max(few_flops, flops_of(branch, options_)), watch_, &of_structure)
                  : NAN;
    if (!of_structure.empty()) {
        point.multipliers = std::move(of_structure);
        point.multiplier_error = 0;
        one->truncate(0);
        one->append(std::move(point));
    }
    check_top(options_.accuracy, peak.above, watch_, *one);
    warn_of_harmonics(limits, error, *one);
    if (is_peak && options_.n_harmonics != 0 && !one->points()[0].motion)
        within(effort_left(),
               [&] { warn_of_given_harmonics(reduced, options_, dof, measure, harmonic, *one); });
    const WorkCount told; // what is known is told, whatever is left of the effort
    check_peak(window_, options_.accuracy, by_basis, watch_, *one);
    if (is_peak) check_stability(branch, of, options_.accuracy, watch_, *one);
    if (one->reduced().model)
        check_host_reduction(*one->reduced().model, options_.accuracy, by_basis,
                             watch_.keeping(one->warnings));
    peak.basis_error = by_basis;
    one->unknowns_used = branch.unknowns_used;
    peak.frequency_hz = one->points()[0].omega / (2 * M_PI);
    peak.amplitude = one->amplitude(0, dof, measure, harmonic);
    peak.branch = one;
    return peak;
}

} // namespace plm
