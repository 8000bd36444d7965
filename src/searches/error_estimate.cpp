#include "searches/error_estimate.hpp"
#include "hbm/formulation.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/make_system.hpp"
#include "hbm/solved_point.hpp"
#include "motions/branch_path.hpp"
#include "motions/effort_budget.hpp"
#include "motions/penetration.hpp"
#include "orbits/orbit_cost.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/orbit_points.hpp"
#include "paths/metric.hpp"
#include "reduction/compression.hpp"
#include "searches/curve.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// The unknowns of `to` for a point of `from`: in compliance form they depend on the structure's own
// stiffness, not on the penetration alone, so both that and the contact forces are carried over.
Matrix gaps_of(const BranchPoint &p, const ReducedModel &from, const ReducedModel &to, HbmOptions o) {
    const ContactMotion motion = whole_contact_motion(from, p);
    const LawForm law = make_formulation(to, o);
    o.n_harmonics = motion.u.cols() / 2;
    Matrix x = whole_penetration_of(from, p, o.n_harmonics);
    if (!law.compliant) return x;
    ContactIndicator indicator;
    Matrix force(x.rows(), x.cols());
    make_contact_force(o, x.rows())->indicator(motion.u, indicator);
    apply_indicator(indicator, *motion.stiffness, motion.u, force);
    for (std::int64_t k = 0; k < x.cols(); ++k)
        for (std::int64_t i = 0; i < x.rows(); ++i) x(i, k) += law.slack[i] * force(i, k);
    return x;
}

constexpr double contracts = 0.5;    // second step over first with one tangent: else it does not hold so far
constexpr double settled = 0.05;     // last step over first, with tangents renewed
constexpr double negligible = 1e-10; // relative step that asks for no more
constexpr double diverged = 1.0;     // relative step that has left the neighbourhood of the point
constexpr int most_steps = 8;

// One point in the gaps of the unreduced structure, corrected step by step across the curve.
class Correction {
  public:
    /// start: in the coordinates of `from`.
    Correction(std::shared_ptr<const ReducedModel> full, const HbmOptions &options, const BranchPoint &start,
               const ReducedModel &from)
        : full_(std::move(full)), system_(make_system(full_, options)), x_(system_->size()),
          omega_(start.omega), period_multiple_(options.period_multiple) {
        const Matrix gaps = gaps_of(start, from, *full_, options);
        const std::int64_t known = std::min(gaps.rows() * gaps.cols(), system_->size());
        std::copy(gaps.data(), gaps.data() + known, x_.begin());
    }

    // Newton's step from here across the tangent; that of the first one is kept. Its length, by the solution
    // and the frequency themselves.
    double step(bool with_new_tangent) {
        const std::int64_t n = system_->size();
        vector<double> change(n);
        system_->residual(x_.data(), omega_, change.data());
        if (with_new_tangent) {
            system_->linearize();
            tangent_ = tangent_at(*system_);
        }
        system_->solve(change.data(), 1);
        const double size = norm2(n, x_.data());
        const Metric metric{size > 0 ? size : 1, omega_};
        const PathState step = step_across(metric, tangent_, change);
        const double length = metric.length(step);
        for (std::int64_t i = 0; i < n; ++i) x_[i] += step.x[i];
        omega_ += step.parameter;
        if (!std::isfinite(omega_) || !std::isfinite(norm2(n, x_.data())))
            throw Error(status::convergence,
                        "the tangent of the unreduced structure is singular at this point")
                .argument("point")
                .reason(reason::singular_tangent);
        return length;
    }

    // The second step, and more with tangents renewed where the first one's does not hold as far as the first
    // step (`length`) went. False: they do not contract, the point is worth nothing.
    bool settle(double length) {
        double last = length, now = step(false);
        if (now <= contracts * last + negligible) return true;
        for (int k = 0; k < most_steps; ++k) {
            last = now;
            now = step(true);
            if (!(now < diverged)) return false;
            if (now <= settled * length + negligible) return true;
        }
        return false;
    }

    double amplitude(std::int64_t dof, Measure measure, std::int64_t harmonic) {
        Branch alone(full_, 0.0, period_multiple_);
        alone.append(point());
        return alone.amplitude(0, dof, measure, harmonic);
    }
    BranchPoint point() {
        BranchPoint p;
        system_->to_point(x_.data(), omega_, p);
        return p;
    }
    double frequency_hz() const { return omega_ / (2 * M_PI); }

  private:
    std::shared_ptr<const ReducedModel> full_;
    std::unique_ptr<HbmSystem> system_;
    vector<double> x_;
    PathState tangent_;
    double omega_;
    std::int64_t period_multiple_;
};

// Harmonic balance at the frequency of an exact motion, with the harmonics of the options.
bool solve_with_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                          BranchPoint &point) {
    const auto system = make_system(std::move(reduced), options);
    vector<double> x = unknowns_of(*system, point);
    const NewtonOutcome out = newton_at(*system, newton_limits(options), x, point.omega);
    if (out.converged) put_solution(*system, {x, point.omega}, out.residual, out.iterations, point);
    return out.converged;
}

double amplitude_alone(const Branch &branch, const BranchPoint &point, std::int64_t dof, Measure measure,
                       std::int64_t harmonic) {
    Branch alone(branch.reduced_model(), branch.force_scale(), branch.period_multiple());
    alone.append(point);
    return alone.amplitude(0, dof, measure, harmonic);
}

std::int64_t finer(std::int64_t harmonics) {
    return 2 * harmonics + 2;
}

} // namespace

ErrorEstimator::ErrorEstimator(std::shared_ptr<const ReducedModel> full, const Branch &branch,
                               const HbmOptions &options, double affordable)
    : branch_(branch), full_(std::move(full)), options_(options), affordable_(affordable) {
    options_.unknowns = NonlinearUnknowns::gaps;
    options_.period_multiple = branch.period_multiple();
    if (full_->n_pairs() == 0)
        throw Error(status::state, "errors are estimated in the contact gaps: the model needs contact pairs");
}

ErrorEstimate ErrorEstimator::estimate(std::int64_t point, std::int64_t dof, Measure measure,
                                       std::int64_t harmonic, bool with_harmonics) const {
    const BranchPoint &p = branch_.points().at(static_cast<std::size_t>(point));
    if (p.force_scale == 0 && norm2(p.eta.rows() * p.eta.cols(), p.eta.data()) > 0)
        throw Error(status::argument,
                    "the point is a motion without excitation, whose error is not estimated")
            .argument("point")
            .index(point);
    HbmOptions o = options_at(p, branch_.period_multiple(), options_);
    ErrorEstimate e;
    if (moves_whole(point)) return by_exact_motion(point, dof, measure, harmonic);
    BranchPoint from = p;
    if (p.motion) { // no harmonics are missing: what both structures answer with as many differs by the basis
        with_harmonics = false;
        o.n_harmonics = std::min(o.n_harmonics, options_.max_harmonics);
        e.known = solve_with_harmonics(branch_.reduced_model(), o, from);
    }
    double amplitude = branch_.amplitude(point, dof, measure, harmonic), hz = p.omega / (2 * M_PI);
    if (p.motion && e.known) amplitude = amplitude_alone(branch_, from, dof, measure, harmonic);
    const auto settle = [&](Correction &c, double ErrorParts::*part) {
        const double a = c.amplitude(dof, measure, harmonic), f = c.frequency_hz();
        e.amplitude.*part = a - amplitude;
        e.frequency_hz.*part = f - hz;
        amplitude = a, hz = f;
    };
    Correction c(full_, o, from, *branch_.reduced_model());
    const double length = c.step(true);
    settle(c, &ErrorParts::basis);
    e.known = c.settle(length) && e.known;
    settle(c, &ErrorParts::contact);
    if (e.known && with_harmonics) {
        o.n_harmonics = finer(o.n_harmonics);
        Correction more(full_, o, c.point(), *full_);
        const double further = more.step(true);
        settle(more, &ErrorParts::harmonics);
        if (!more.settle(further)) e.amplitude.harmonics = e.frequency_hz.harmonics = NAN;
    }
    if (!e.known) e.amplitude = e.frequency_hz = {NAN, NAN, NAN};
    return e;
}

bool ErrorEstimator::moves_whole(std::int64_t point) const {
    const HbmOptions o =
        options_at(branch_.points().at(static_cast<std::size_t>(point)), branch_.period_multiple(), options_);
    return branch_.points()[static_cast<std::size_t>(point)].motion && !branch_.reduced().all_pairs &&
           !decays_hopelessly(*full_) &&
           EffortBudget::steps_beside * exact_step_flops(*full_, o) <= affordable_;
}

// The whole structure's own motion, across the curve from the point's own state. Nothing of it is cut off.
ErrorEstimate ErrorEstimator::by_exact_motion(std::int64_t point, std::int64_t dof, Measure measure,
                                              std::int64_t harmonic) const {
    const BranchPoint &p = branch_.points()[static_cast<std::size_t>(point)];
    HbmOptions o = options_;
    o.force_scale = p.force_scale;
    o.period_multiple = branch_.period_multiple();
    const auto part = as_part_of(full_, branch_.reduced());
    Branch in_part(part, branch_.force_scale(), branch_.period_multiple());
    in_part.append(p);
    BranchPoint own = p;
    NewtonWork work;
    ErrorEstimate e;
    e.known = make_exact_beside(full_, o, start_of(in_part, 0), own, work);
    if (!e.known) {
        e.amplitude = e.frequency_hz = {NAN, NAN, NAN};
        return e;
    }
    Branch alone(full_, branch_.force_scale(), branch_.period_multiple());
    alone.append(own);
    e.amplitude.basis =
        alone.amplitude(0, dof, measure, harmonic) - branch_.amplitude(point, dof, measure, harmonic);
    e.frequency_hz.basis = (own.omega - p.omega) / (2 * M_PI);
    e.multipliers = std::move(own.multipliers);
    return e;
}

BranchPoint ErrorEstimator::corrected(std::int64_t point) const {
    const BranchPoint &p = branch_.points().at(static_cast<std::size_t>(point));
    Correction c(full_, options_at(p, branch_.period_multiple(), options_), p, *branch_.reduced_model());
    const BranchPoint as_computed = c.point();
    return c.settle(c.step(true)) ? c.point() : as_computed;
}

} // namespace plm
