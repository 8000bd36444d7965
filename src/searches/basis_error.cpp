#include "searches/basis_error.hpp"
#include "hbm/harmonic_choice.hpp"
#include "linalg/work.hpp"
#include "motions/effort_budget.hpp"
#include "motions/motion_measures.hpp"
#include "orbits/orbit_cost.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm {
namespace {

// An exact motion is compared with fewer harmonics than it has where they are many, but not with fewer.
constexpr std::int64_t least_harmonics = 5;
// A point that misses the equations of the whole structure by more of its size is too far from the better
// solution for steps along tangents to tell how far.
constexpr double too_far = 0.02;
constexpr double not_judged = std::numeric_limits<double>::quiet_NaN();

// Harmonics to estimate with; 0: too many gaps.
std::int64_t affordable_harmonics(const Branch &branch, std::int64_t point, double flops) {
    const BranchPoint &p = branch.points()[static_cast<std::size_t>(point)];
    const std::int64_t has = harmonics_of(p, branch.period_multiple()) * branch.period_multiple(),
                       unknowns = static_cast<std::int64_t>(std::cbrt(flops / EffortBudget::of_factor)),
                       most = (unknowns / branch.reduced().n_whole_pairs() - 1) / 2;
    if (has <= most) return std::max<std::int64_t>(has, 1);
    return p.motion && most >= least_harmonics * branch.period_multiple() ? most : 0;
}

// Whether the unreduced structure is there to be asked, and what it answers differs by the basis alone:
// forces from samples miss by themselves, and so does damping by a matrix and by ratios at once.
bool can_be_judged(const Basis &basis, const Branch &branch, double flops) {
    const Damping &damping = basis.model()->damping();
    const Space &space = *basis.space();
    return space.is_contact_space && branch.reduced().n_pairs() > 0 && !branch.sampled && !branch.is_mode &&
           !(damping.has_matrix && !damping.modal_ratio.empty()) &&
           static_cast<double>(space.vectors.rows()) * static_cast<double>(space.size()) <
               EffortBudget::numbers_for_a_flop * flops;
}

} // namespace

bool is_unreduced(const ReducedModel &reduced, const Basis &basis) {
    return reduced.size() >= basis.space()->size() && !reduced.all_pairs;
}

double basis_error(const ErrorEstimator &estimator, const Branch &branch, std::int64_t point,
                   const Output &output, double peak, vector<std::complex<double>> *multipliers) {
    const ErrorEstimate e = estimator.estimate(point, output.dof, output.measure, output.harmonic, false);
    if (!e.known) return std::numeric_limits<double>::infinity();
    if (multipliers && !e.multipliers.empty()) *multipliers = e.multipliers;
    const double hz = branch.points()[static_cast<std::size_t>(point)].omega / (2 * M_PI);
    return std::max(std::abs(e.amplitude.basis + e.amplitude.contact) / std::abs(peak),
                    std::abs(e.frequency_hz.basis + e.frequency_hz.contact) / hz);
}

double basis_error_at(const std::shared_ptr<const Basis> &basis, const HbmOptions &options,
                      const Branch &branch, std::int64_t point, const Output &output, double flops,
                      Watch watch, vector<std::complex<double>> *multipliers) {
    if (!basis || !can_be_judged(*basis, branch, flops)) return not_judged;
    const double amplitude = branch.amplitude(point, output.dof, output.measure, output.harmonic);
    if (amplitude == 0) return not_judged;
    if (is_unreduced(branch.reduced(), *basis)) return 0;
    double error = not_judged;
    try {
        HbmOptions o = options;
        o.max_harmonics = affordable_harmonics(branch, point, flops) / branch.period_multiple();
        within(EffortBudget::most * effort_left(), [&] {
            const ErrorEstimator estimator(unreduced_basis(basis, watch)->reduced(), branch, o, flops);
            const bool by_harmonics = !estimator.moves_whole(point);
            if (by_harmonics && o.max_harmonics == 0) return;
            error = by_harmonics && branch.full_residual(point) > too_far
                        ? std::numeric_limits<double>::infinity()
                        : basis_error(estimator, branch, point, output, amplitude, multipliers);
        });
        return error;
    } catch (const Error &e) { // a tangent that is singular, motions that nothing holds
        if (e.status() == status::cancelled || e.status() == status::memory || e.status() == status::callback)
            throw;
        return not_judged;
    }
}

double flops_of(const Branch &curve, const HbmOptions &options) {
    return static_cast<double>(curve.newton_work.iterations) * exact_step_flops(curve.reduced(), options);
}

double multiplier_error_of(const std::shared_ptr<const Basis> &basis, const HbmOptions &options,
                           const Branch &curve, double flops, Watch watch) {
    if (!basis || !basis->space()->is_contact_space || is_unreduced(curve.reduced(), *basis)) return 0;
    const auto &points = curve.points();
    const auto from_circle = [&](std::int64_t i) {
        const auto &m = points[static_cast<std::size_t>(i)].multipliers;
        return m.empty() ? INFINITY : std::abs(std::abs(m[0]) - 1);
    };
    std::int64_t nearest = 0;
    for (std::int64_t i = 1; i < static_cast<std::int64_t>(points.size()); ++i)
        if (from_circle(i) < from_circle(nearest)) nearest = i;
    double worst = 0;
    const auto compare = [&] {
        const ErrorEstimator estimator(unreduced_basis(basis, watch)->reduced(), curve, options, flops / 2);
        for (std::int64_t i : {largest_response(curve), nearest}) {
            if (!std::isfinite(from_circle(i)) || !estimator.moves_whole(i)) continue;
            const ErrorEstimate e = estimator.estimate(i, 0, Measure::peak, 0, false);
            if (!e.multipliers.empty())
                worst =
                    std::max(worst, std::abs(std::abs(points[static_cast<std::size_t>(i)].multipliers[0]) -
                                             std::abs(e.multipliers[0])));
        }
    };
    try {
        within(EffortBudget::most * effort_left(), compare);
    } catch (const Error &e) {
        if (e.status() == status::cancelled || e.status() == status::memory) throw;
    }
    return worst;
}

} // namespace plm
