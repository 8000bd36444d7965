// The peak of a curve, what may be wrong with it, and what has to be said.
#include "hbm/harmonic_choice.hpp"
#include "linalg/work.hpp"
#include "motions/curve_verdicts.hpp"
#include "motions/effort_budget.hpp"
#include "motions/error_budget.hpp"
#include "motions/peak_search.hpp"
#include "orbits/orbit_cost.hpp"
#include "searches/basis_error.hpp"
#include "searches/compressed_curve.hpp"
#include "searches/curve.hpp"
#include "searches/hbm.hpp"
#include "searches/motion_in_time.hpp"
#include "searches/point_equations.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace plm {
namespace {

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

    // Where harmonics are chosen, an order better than on the curve.
    void close_in() {
        const double wanted = ErrorBudget::peak_of_harmonics * options_.allowed_harmonic_error();
        if (automatic_) error_ = error_here();
        do {
            if (error_ > wanted)
                options_.n_harmonics =
                    std::max(options_.n_harmonics, std::min(most_harmonics_, 2 * options_.n_harmonics));
            equations_ = equations_of(reduced_, options_, point_, StabilityOf::point);
            search_ = std::make_unique<PeakSearch>(*equations_, options_, options_.aft == AftKind::sampled,
                                                   reduced_, of_, watch_);
            search_->run(branch_, around_, point_);
            if (automatic_) error_ = error_here();
        } while (error_ > wanted && options_.n_harmonics < most_harmonics_);
    }

    // The next harmonics tell little where the motion is a tangle of bounces; what it does in time tells.
    void look_in_time() {
        if (!automatic_ || !(error_ > options_.allowed_harmonic_error())) return;
        if (!reduced_->same_static || !has_flow(*reduced_)) return;
        const HarmonicChange change = change_in_time(reduced_, options_, point_, watch_);
        error_ = harmonic_error_at(*reduced_, point_, change, of_.dof, of_.measure, of_.harmonic);
        in_time_ = true;
        watch_.log(1, format("some periods in time change the peak by about %.2g of itself", error_));
    }

    void find_multipliers() {
        if (equations_) point_.multipliers = multipliers_at(*equations_, point_);
    }

    const BranchPoint &point() const { return point_; }
    double harmonic_error() const { return error_; }
    bool seen_in_time() const { return in_time_; }
    /// As PeakSearch; where none came to its end, by how much the lower neighbour is lower: a parabola rises
    /// less.
    double above() const {
        if (search_ && !std::isnan(search_->above())) return search_->above();
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
    bool automatic_;       // harmonics are chosen
    bool in_time_ = false; // error_ is by the motion in time
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
    return inner || (branch.end_reason == reason::loop_closed && n > 3);
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
    if (top > 0 && branch.end_reason != reason::range_end)
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
    one->end_reason = reason::range_end;
    BranchPoint point = branch.points()[top];
    const HbmOptions limits = with_affordable_harmonics(*reduced, options_);
    const Output of{dof, measure, harmonic};
    double error = point.motion ? 0 : point.harmonic_error; // an exact motion lacks no harmonics
    if (is_peak) {
        // of the effort that is left: for the peak itself, then for each of what is said of it, of which the
        // estimate of the error by the basis is the last; an exact motion has its multipliers with it, and
        // nothing to look for in time
        CloserLook look(reduced, options_, branch, around, of, watch_);
        within((point.motion ? EffortBudget::most : EffortBudget::half) * effort_left(),
               [&] { look.close_in(); });
        within(EffortBudget::half * effort_left(), [&] { look.look_in_time(); });
        const bool in_time = within(EffortBudget::half * effort_left(), [&] { look.find_multipliers(); });
        const double multiplier_error = point.multiplier_error;
        point = look.point();
        point.multiplier_error = multiplier_error;
        error = look.harmonic_error();
        peak.above = look.above();
        peak.seen_in_time = look.seen_in_time();
        if (options_.stability != StabilityKind::off && point.multipliers.empty())
            one->warnings.add(reason::unverified,
                              in_time ? Stability(reduced, options_, StabilityOf::point).unknown_text(1, 1)
                                      : "the stability of the peak is not known: the effort allowed was "
                                        "spent before; raise the effort of the context");
    } else { // it stays where it is
        watch_.keeping(one->warnings).warn(reason::no_peak, why_no_peak(branch, top, of_motion, of));
    }
    one->append(point);
    vector<std::complex<double>> of_structure;
    double by_basis = of_motion ? basis_error_at(made_as_, options_, *one, 0, of,
                                                 std::max(EffortBudget::aside, flops_of(branch, options_)),
                                                 watch_, &of_structure)
                                : NAN;
    if (std::isnan(by_basis) && of_motion && made_as_ && is_unreduced(*made_as_->reduced(), *made_as_))
        by_basis = branch.model_error;
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
    const BranchPoint &found = one->points()[0]; // where nothing was seen in time, of its motion as a whole
    peak.harmonic_error = found.motion ? 0 : peak.seen_in_time ? error : found.harmonic_error;
    one->unknowns_used = branch.unknowns_used;
    peak.frequency_hz = one->points()[0].omega / (2 * M_PI);
    peak.amplitude = one->amplitude(0, dof, measure, harmonic);
    peak.branch = one;
    return peak;
}

} // namespace plm
