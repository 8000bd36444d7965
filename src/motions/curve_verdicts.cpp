#include "motions/curve_verdicts.hpp"
#include "contact/contact_measures.hpp"
#include "motions/error_budget.hpp"
#include "motions/motion_measures.hpp"
#include "reduction/compression.hpp"
#include "space/audit.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm {
namespace {

// No result of this library is to be wrong by more without a word.
constexpr double missed = 0.01;
// A host that goes up from small forces begins within two decades of where contact changes.
constexpr double far_from_switching = 100;

bool is_inside(const SweepRange &window, const BranchPoint &p) {
    const double hz = p.omega / (2 * M_PI);
    constexpr double on_the_end = 1e-6; // relative: rounding of the range in Hz and in rad/s
    return hz > window.min_hz * (1 - on_the_end) && hz < window.max_hz * (1 + on_the_end);
}

// The point outside the window where the response is largest; -1: all lie inside.
std::int64_t largest_outside(const SweepRange &window, const Branch &branch) {
    std::int64_t best = -1;
    double most = -1;
    for (std::size_t i = 0; i < branch.points().size(); ++i) {
        if (is_inside(window, branch.points()[i])) continue;
        const double size = response_size(branch, static_cast<std::int64_t>(i));
        if (size > most) most = size, best = static_cast<std::int64_t>(i);
    }
    return best;
}

// A right answer to a question that was hardly meant: away from the resonance that the basis is for, and
// linear.
bool is_beside_the_point(const SweepRange &window, const Branch &branch) {
    for (const BranchPoint &p : branch.points())
        if (p.n_switching > 0 || is_inside(window, p)) return false;
    return branch.points().size() > 1 && branch.reduced().n_pairs() > 0;
}

// All of it outside a window that it would hold if its frequencies were rad/s.
bool looks_like_rad_s(const SweepRange &window, const Branch &branch) {
    double low = INFINITY, high = 0;
    for (const BranchPoint &p : branch.points()) {
        if (is_inside(window, p)) return false;
        low = std::min(low, p.omega), high = std::max(high, p.omega);
    }
    // as rad/s its frequencies would be what they are now in Hz
    const double middle = 0.5 * (window.min_hz + window.max_hz), hz = 2 * M_PI;
    return low / hz <= hz * middle && high / hz >= hz * middle;
}

// Whether what the full residual shows is the basis alone: forces from samples miss by themselves, and of
// damping by a matrix and by ratios at once it sees the matrix only.
bool shows_the_basis(const Branch &branch) {
    const Damping &damping = branch.reduced().model->damping();
    return !branch.sampled && !branch.is_mode && !(damping.has_matrix && !damping.modal_ratio.empty());
}

// A basis that was read from bytes, without its model: what would be compared with the structure is not.
bool has_structure(Watch watch, Branch &branch) {
    if (branch.reduced().model->is_whole()) return true;
    watch.keeping(branch.warnings)
        .warn(reason::unverified,
              "the response was not compared with the equations of the whole structure, since the basis was "
              "read from bytes and its model is not attached; attach it to have that done");
    return false;
}

} // namespace

void check_window(const SweepRange &window, Watch watch, Branch &branch) {
    if (!(window.max_hz > 0) || !branch.reduced().model) return;
    const std::int64_t worst = largest_outside(window, branch);
    if (worst < 0 || !has_structure(watch, branch)) return;
    const double residual = branch.full_residual(worst);
    if (residual <= missed && is_beside_the_point(window, branch))
        watch.keeping(branch.warnings)
            .warn(
                reason::outside_basis,
                format("the whole curve lies outside the %.6g to %.6g Hz that the basis is made for, and no "
                       "contact pair opens or closes on it. Are the limits in Hz (rad/s over 2 pi)? Sweep "
                       "over the window, or name the mode that is meant (\"mode\" of the sampler)",
                       window.min_hz, window.max_hz));
    if (residual <= missed) return;
    watch.keeping(branch.warnings)
        .warn(
            reason::outside_basis,
            format(
                "the basis is made for %.6g to %.6g Hz; at %.6g Hz the response misses the equations of the "
                "whole structure by %.2g of its size (full residual). Build a basis for these frequencies: "
                "frequency_min_hz and frequency_max_hz of the basis, or window_min_hz and window_max_hz of "
                "the sampler%s",
                window.min_hz, window.max_hz,
                branch.points()[static_cast<std::size_t>(worst)].omega / (2 * M_PI), residual,
                looks_like_rad_s(window, branch) ? "; or are the limits in rad/s? They are wanted in Hz"
                                                 : ""));
}

namespace {

void warn_of_basis(const BranchPoint &p, const std::string &how_wrong, Watch watch, Branch &branch) {
    watch.keeping(branch.warnings)
        .warn(reason::basis_too_small,
              format("the basis (%lld coordinates) is too small: at %.6g Hz %s. %s",
                     static_cast<long long>(uncompressed(branch.reduced_model())->size()),
                     p.omega / (2 * M_PI), how_wrong.c_str(),
                     branch.reduced().all_pairs
                         ? "Carry more pairs (n_pairs_carried), or raise below_factor of the basis"
                         : "Raise n_harmonics of sampler and basis or below_factor of the basis, refine the "
                           "basis for this DOF, or take kind \"full\""));
}

} // namespace

void check_basis(const SweepRange &window, const std::function<double()> &error, Watch watch,
                 Branch &branch) {
    if (!branch.reduced().model || branch.points().empty() || !shows_the_basis(branch)) return;
    const std::int64_t top = largest_response(branch);
    const BranchPoint &p = branch.points()[static_cast<std::size_t>(top)];
    if (window.max_hz > 0 && !is_inside(window, p)) return; // check_window() speaks of that
    if (!has_structure(watch, branch)) return;
    const double residual = branch.full_residual(top);
    if (residual <= missed) return;
    if (error() <= missed) return; // which NaN is not
    warn_of_basis(p,
                  format("the response misses the equations of the whole structure by %.2g of its size (full "
                         "residual), and amplitudes are in doubt by as much (the error estimate of a point "
                         "tells)",
                         residual),
                  watch, branch);
}

void check_peak(const SweepRange &window, double accuracy, double error, Watch watch, Branch &peak) {
    if (!std::isfinite(error))
        check_basis(
            window, [=] { return error; }, watch, peak);
    if (std::isinf(error) && peak.warnings.has(reason::basis_too_small)) return; // that is said
    if (std::isinf(error))
        watch.keeping(peak.warnings)
            .warn(reason::no_contraction,
                  format("how much the basis (%lld coordinates) changes this peak, at %.6g Hz, is not known: "
                         "the steps from it to the motion of the whole structure do not contract, so that it "
                         "may be off by more than \"accuracy\" allows. Compare with a larger basis (more "
                         "n_harmonics of sampler and basis, or below_factor) or with kind \"full\"",
                         static_cast<long long>(uncompressed(peak.reduced_model())->size()),
                         peak.points()[0].omega / (2 * M_PI)));
    else if (error > accuracy)
        warn_of_basis(
            peak.points()[0],
            format("the amplitude asked for is wrong by about %.2g of itself, by an estimate (or the "
                   "frequency is), where \"accuracy\" allows %.2g",
                   error, accuracy),
            watch, peak);
}

void check_top(double accuracy, double above, Watch watch, Branch &peak) {
    if (above <= accuracy) return;
    watch.keeping(peak.warnings)
        .warn(reason::unverified,
              format("the peak, at %.6g Hz, is only the highest point of the curve: no solutions were found "
                     "close around it, or the effort allowed was spent before, and by its neighbours the "
                     "peak may be higher by about %.2g of itself, where \"accuracy\" allows %.2g. Sweep with "
                     "a smaller max_step, allow more max_iterations, or raise the effort of the context",
                     peak.points()[0].omega / (2 * M_PI), above, accuracy));
}

namespace {

// A bifurcation ends the stable motions on one side of it.
bool ends_stable_motions(const std::vector<BranchPoint> &points, std::size_t i) {
    const auto stable = [&](std::size_t k) { return k < points.size() && stability_of(points[k]) == 1; };
    return points[i].bifurcation != bifurcation::none && (stable(i + 1) || (i > 0 && stable(i - 1)));
}

} // namespace

std::int64_t highest_stable(const Branch &curve, const Output &of) {
    const std::vector<BranchPoint> &points = curve.points();
    std::int64_t best = -1;
    double most = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (stability_of(points[i]) != 1 && !ends_stable_motions(points, i)) continue;
        const double height = curve.amplitude(static_cast<std::int64_t>(i), of.dof, of.measure, of.harmonic);
        if (height > most) most = height, best = static_cast<std::int64_t>(i);
    }
    return best;
}

namespace {

// Beyond a fold the structure goes to the stable motions beside it.
bool is_saddle(const BranchPoint &p) {
    return std::all_of(p.multipliers.begin(), p.multipliers.end(),
                       [](const auto &m) { return std::abs(m) <= 1 || (m.real() > 0 && m.imag() == 0); });
}

bool has_stable_motion(const Branch &curve, double omega) {
    const std::vector<BranchPoint> &points = curve.points();
    for (std::size_t k = 1; k < points.size(); ++k)
        if ((points[k - 1].omega - omega) * (points[k].omega - omega) <= 0 &&
            std::max(stability_of(points[k - 1]), stability_of(points[k])) == 1)
            return true;
    return false;
}

} // namespace

vector<std::int64_t> left_for_others(const Branch &curve) {
    vector<std::int64_t> found;
    for (std::size_t i = 0; i < curve.points().size(); ++i) {
        const BranchPoint &p = curve.points()[i];
        if (stability_of(p) == 0 && (!is_saddle(p) || !has_stable_motion(curve, p.omega)))
            found.push_back(static_cast<std::int64_t>(i));
    }
    return found;
}

namespace {

// Whether stable motions end at a fold beside the peak, hardly lower: then the structure comes as far. Beyond
// any other bifurcation the stable motions that come out of it may be larger.
bool is_beside_a_fold(const Branch &curve, const Output &of, double least) {
    const std::vector<BranchPoint> &points = curve.points();
    const std::int64_t top = curve.highest_point(of.dof, of.measure, of.harmonic),
                       n = static_cast<std::int64_t>(points.size());
    for (const std::int64_t step : {-1, 1})
        for (std::int64_t i = top; i >= 0 && i < n; i += step) {
            const BranchPoint &p = points[static_cast<std::size_t>(i)];
            if (curve.amplitude(i, of.dof, of.measure, of.harmonic) < least) break;
            if (stability_of(p) == 1) return true;
            if (p.bifurcation == bifurcation::fold &&
                ends_stable_motions(points, static_cast<std::size_t>(i)))
                return true;
            if (p.bifurcation != bifurcation::none) break;
        }
    return false;
}

} // namespace

void check_stability(const Branch &curve, const Output &of, double accuracy, Watch watch, Branch &peak) {
    const BranchPoint &top = peak.points()[0];
    const std::int64_t is_stable = stability_of(top);
    if (is_stable == 1 || top.multipliers.empty()) return;
    const double height = peak.amplitude(0, of.dof, of.measure, of.harmonic);
    const std::int64_t stable = highest_stable(curve, of);
    const double known = stable < 0 ? 0 : curve.amplitude(stable, of.dof, of.measure, of.harmonic);
    if (is_beside_a_fold(curve, of, (1 - accuracy) * height)) return;
    const std::string instead =
        stable < 0 ? "No motion of the curve is known to be stable"
                   : format("The highest stable motion of the curve is %.6g, at %.6g Hz", known,
                            curve.points()[static_cast<std::size_t>(stable)].omega / (2 * M_PI));
    const double largest = std::abs(top.multipliers[0]);
    const std::string verdict =
        is_stable == 0
            ? format("is not stable (largest multiplier %.4g): the structure leaves it for another one",
                     largest)
            : format("may not be stable: its largest multiplier is %.4g, but may be off by %.2g by the basis",
                     largest, top.multiplier_error);
    watch.keeping(peak.warnings)
        .warn(reason::unstable_peak,
              format("the motion of the peak, %.6g at %.6g Hz, %s. %s. What it does instead, time marching "
                     "tells, or, where it repeats after several periods of the excitation, a curve with "
                     "\"period_multiple\" of 2 or more",
                     height, top.omega / (2 * M_PI), verdict.c_str(), instead.c_str()));
}

void check_host_reduction(const Model &model, double accuracy, double error, Watch watch) {
    const double of_host = model.space_options().reduction_error;
    if (of_host <= ErrorBudget(accuracy).host() || error + of_host <= accuracy) return;
    watch.warn(
        reason::host_reduction,
        format("the model is a superelement whose own error is stated to be %.2g (\"reduction_error\"): "
               "of the accuracy %.2g that takes more than half, whatever the basis. Reduce the structure "
               "with more modes or contact attachment vectors, or ask for less accuracy",
               of_host, accuracy));
}

bool spans(const Branch &curve) {
    return curve.end_reason == reason::range_end && !curve.warnings.has(reason::turned_back);
}

void check_span(bool upward, Watch watch, Branch &branch) {
    if (branch.end_reason == reason::loop_closed)
        watch.keeping(branch.warnings)
            .warn(reason::loop_closed,
                  format("the sweep began, at %.6g Hz, on a closed curve and came back to its first point: "
                         "it says nothing of the response outside that loop, whose peak may be much higher, "
                         "and no curve was found from the other end. Sweep over a wider range "
                         "(frequency_min_hz, frequency_max_hz), whose ends lie beside the loop",
                         branch.points().front().omega / (2 * M_PI)));
    if (branch.end_reason != reason::range_end || branch.points().empty()) return;
    // it may have begun a little inside the range
    const double begin = branch.points().front().omega, end = branch.points().back().omega;
    constexpr double same = 1e-9; // of the frequency: the boundary of the range
    if ((upward ? end - begin : begin - end) > same * begin) return;
    double farthest = begin;
    for (const BranchPoint &p : branch.points())
        if (std::abs(p.omega - begin) > std::abs(farthest - begin)) farthest = p.omega;
    const bool from_above = !upward;
    watch.keeping(branch.warnings)
        .warn(
            reason::turned_back,
            format("the curve began at %.6g Hz, folded at %.6g Hz and came back: it says nothing of what is "
                   "%s. Sweep from the other end, too (\"direction\"), and over a wider range, and look for "
                   "motions of other periods (\"period_multiple\") where it is not stable",
                   begin / (2 * M_PI), farthest / (2 * M_PI), from_above ? "below" : "above"));
}

void check_damping(Watch watch, Branch &branch) {
    if (!branch.reduced().model || branch.points().empty() || !is_undamped(*branch.reduced().model)) return;
    const std::int64_t top = largest_response(branch),
                       last = static_cast<std::int64_t>(branch.points().size()) - 1;
    if (spans(branch) && (top == 0 || top == last)) return; // beside all resonances
    watch.keeping(branch.warnings)
        .warn(reason::model,
              "the model has no damping: at a resonance the response is unbounded, and a curve ends there or "
              "bounces without end. Give the model modal, Rayleigh or structural damping");
}

void check_switching(Watch watch, Branch &branch) {
    if (branch.reduced().n_pairs() == 0) return;
    for (const BranchPoint &p : branch.points())
        if (p.n_switching > 0) return;
    const std::int64_t top = largest_response(branch);
    if (!(response_size(branch, top) > 0)) return; // nothing is excited
    const double factor = factor_to_switching(branch.penetration_coefficients(top).transposed());
    if (factor < far_from_switching) return;
    watch.keeping(branch.warnings)
        .warn(reason::no_switching,
              std::isfinite(factor)
                  ? format("no contact pair opens or closes on this curve, nor would one unless the motion "
                           "were %.2g times as large: this is a linear response. Check the units of gaps, "
                           "pre-load and excitation, and the direction of the pairs",
                           factor)
                  : "no contact pair opens or closes on this curve, however large the excitation: it moves "
                    "none of them. Check where it acts, and that it has a harmonic of 1 or above (a constant "
                    "force is a pre-load)");
}

} // namespace plm
