#include "orbits/stability.hpp"
#include "linalg/lapack.hpp"
#include "linalg/scale.hpp"
#include "motions/effort_budget.hpp"
#include "motions/free_motion.hpp"
#include "orbits/exact_motion.hpp"
#include "orbits/hill.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

namespace {

// The matrix exponentials cost about n^3 each, for two events of every moving pair: beyond this size more
// than the curve itself.
constexpr std::int64_t automatic_size = 24;

// Of one run of the flow: a point by itself is worth more than each one of a curve.
double affordable(const MotionOptions &options, StabilityOf of) {
    if (options.stability != StabilityKind::automatic) return INFINITY;
    return of == StabilityOf::point ? EffortBudget::stability_of_point : MotionBeside::of_curve;
}

// Orthonormal, beside the columns of `free` cut to n rows (what is left out there is 0): n x (n - m).
Matrix complement(const Matrix &free, std::int64_t n) {
    const std::int64_t m = free.cols();
    Matrix square(n, n), beside(n, n - m);
    for (std::int64_t k = 0; k < m; ++k) std::copy_n(free.col(k), n, square.col(k));
    const Matrix turned = thin_svd(square).u; // the first m columns span `free`
    for (std::int64_t k = m; k < n; ++k) std::copy_n(turned.col(k), n, beside.col(k - m));
    return beside;
}

// States without free motion: without its positions and, unless `velocities`, without its velocities. Free
// motions have mass: their coordinates are among the first, as in the state.
Matrix states_beside(const Matrix &free, const FlowModel &flow, bool velocities) {
    const std::int64_t n = flow.n_moving(), speeds = flow.n_massive(), m = free.cols();
    if (m == 0) return {};
    const Matrix y = complement(free, n), v = velocities ? identity(speeds) : complement(free, speeds);
    Matrix states(n + speeds, y.cols() + v.cols());
    for (std::int64_t k = 0; k < y.cols(); ++k) std::copy_n(y.col(k), n, states.col(k));
    for (std::int64_t k = 0; k < v.cols(); ++k) std::copy_n(v.col(k), speeds, states.col(y.cols() + k) + n);
    return states;
}

} // namespace

Stability::Stability(std::shared_ptr<const ReducedModel> reduced, const MotionOptions &options,
                     StabilityOf of)
    : reduced_(std::move(reduced)), beside_(options.period_multiple, affordable(options, of)),
      period_multiple_(options.period_multiple),
      wanted_(options.stability == StabilityKind::floquet || options.stability == StabilityKind::hill ||
              (options.stability == StabilityKind::automatic &&
               (of == StabilityOf::point || reduced_->size() <= automatic_size))),
      hill_(options.stability == StabilityKind::hill) {
    if (wanted_ && reduced_->structural == 0) flow_ = std::make_shared<FlowModel>(reduced_);
}

vector<std::complex<double>> Stability::multipliers(const BranchPoint &point) {
    const auto flow = flow_ ? flow_ : std::make_shared<FlowModel>(reduced_, point.omega);
    if (hill_) return hill_multipliers(*flow, *reduced_, point, period_multiple_);
    const EventSequence sequence = contact_events(*reduced_, point, period_multiple_);
    const Matrix free = free_motion(*reduced_, sequence.acting());
    // A displacement along a free motion stays: multiplier 1. Beside that of its velocity, 1 without damping,
    // it would be a defective pair, which rounding throws off the unit circle.
    const Matrix but_positions = states_beside(free, *flow, true);
    vector<std::complex<double>> found =
        beside_.multipliers(flow, point, sequence, states_beside(free, *flow, false), [&](const Matrix &all) {
            if (!all_finite(all.data(), all.rows() * all.cols())) return vector<std::complex<double>>();
            return plm::multipliers(
                free.cols() == 0 ? all
                                 : product('T', 'N', but_positions, product('N', 'N', all, but_positions)));
        });
    if (found.empty() || free.cols() == 0) return found;
    const auto inside = std::find_if(found.begin(), found.end(), [](auto m) { return std::abs(m) < 1; });
    found.insert(inside, but_positions.rows() - but_positions.cols(), 1.0);
    return found;
}

std::string Stability::unknown_text(std::int64_t n_unknown, std::int64_t n_points) const {
    const std::string why =
        hill_
            ? format("Hill's matrix would be larger than %lld there; set stability to floquet",
                     static_cast<long long>(largest_hill_order))
            : "no exact motion was found beside them, which their harmonics may not describe well enough, or "
              "which would take long to find; take more harmonics, or set stability to floquet, or to off";
    return format("the stability of %lld of %lld points is not known: %s", static_cast<long long>(n_unknown),
                  static_cast<long long>(n_points), why.c_str());
}

} // namespace plm
