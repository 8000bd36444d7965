// A curve on a compressed model held against the whole basis, or a better model: its highest motion, its
// stability, and what is said of both.
#include "motions/branch_path.hpp"
#include "motions/compressed_motion.hpp"
#include "motions/motion_measures.hpp"
#include "orbits/orbit_point.hpp"
#include "searches/compressed_curve.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Of multipliers near the unit circle, on curves of cracked plates; and of motions whose multipliers are
// right to that.
constexpr double multiplier_error = 1e-4, motion_error = 1e-5;

// Half-way between special points, of which one is no fold.
vector<std::size_t> beside_changes(const std::vector<BranchPoint> &points) {
    vector<std::size_t> at;
    std::size_t before = 0;
    bool changed = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::int32_t kind = points[i].bifurcation;
        if (kind == bifurcation::none && i + 1 < points.size()) continue;
        const bool change = kind != bifurcation::none && kind != bifurcation::fold;
        if ((changed || change) && i > before + 1) at.push_back((before + i) / 2);
        before = i, changed = change;
    }
    return at;
}

} // namespace

bool CurveCompression::agrees(const BranchPoint &on_curve, const std::shared_ptr<const ReducedModel> &model,
                              const BranchPoint &there, double amplitude_on_curve, double error) const {
    const double outside = std::abs(there.multipliers[0]) - 1;
    return std::abs(outside) <= multiplier_error || (outside < 0) == (stability_of(on_curve) == 1) ||
           // beside a fold there is another motion of the same frequency
           std::abs(amplitude(model, there) - amplitude_on_curve) > error * peak_;
}

// The best model there is, where a step on it does not take too long: its motion is needed for the stability
// there anyway.
void CurveCompression::compare_with_whole(const Branch &curve) {
    better_ = whole_;
    peak_ = amplitude(curve.reduced_model(), curve.points()[static_cast<std::size_t>(top_)]);
    change_ = std::abs(amplitude(whole_, top_on_better_) - peak_) / peak_;
    watch_.log(1,
               format("on the whole basis of %lld coordinates the highest motion changes by %.2g of itself",
                      static_cast<long long>(whole_->size()), change_));
}

// The whole basis beside a point of the curve: the motion found from the point's own state, or by other ways.
bool CurveCompression::find_on_whole(const Branch &curve, std::int64_t point, BranchPoint &found) {
    const BranchPoint &on_curve = curve.points()[static_cast<std::size_t>(point)];
    HbmOptions nearly = options_;
    nearly.tolerance = std::max(options_.tolerance, motion_error);
    if (!on_whole_)
        on_whole_ = std::make_shared<const OrbitEquations>(
            orbit_equations(whole_, nearly, on_curve.omega, FlowParameter::frequency));
    OrbitEquations equations = orbit_equations(*on_whole_, nearly, on_curve.omega, FlowParameter::frequency);
    PathState at = {equations.unknowns(start_of(curve, point).state), on_curve.omega};
    const vector<double> start = at.x;
    const NewtonOutcome out = newton_at(equations, newton_limits(nearly), at.x, at.parameter);
    double moved = 0;
    for (std::size_t i = 0; i < start.size(); ++i) moved = std::hypot(moved, at.x[i] - start[i]);
    if (out.converged && moved <= same_motion * norm2(equations.size(), at.x.data())) {
        found = orbit_point(equations, nearly, at, out.residual, out.iterations);
        equations.linearize();
        found.multipliers = equations.multipliers();
        return true;
    }
    found = uncompressed(curve.reduced(), on_curve);
    NewtonWork work;
    return make_exact(whole_, nearly, watch_.quiet(), found, work) && !found.multipliers.empty();
}

bool CurveCompression::agrees_on_whole(const Branch &curve, std::int64_t point) {
    BranchPoint p;
    if (better_ == whole_ && point == top_)
        p = top_on_better_;
    else if (!find_on_whole(curve, point, p))
        return false;
    const BranchPoint &on_curve = curve.points()[static_cast<std::size_t>(point)];
    return agrees(on_curve, whole_, p, amplitude(curve.reduced_model(), on_curve), options_.accuracy);
}

// The same on the last model that was better.
bool CurveCompression::agrees_on_better(const Branch &curve, std::int64_t point) {
    const BranchPoint &on_curve = curve.points()[static_cast<std::size_t>(point)];
    BranchPoint p = top_on_better_;
    if (point != top_ || !p.motion) {
        p = uncompressed(curve.reduced(), on_curve);
        if (!make_exact_on(better_, p, ElseMarching::no)) return false;
    }
    if (p.multipliers.empty()) return false;
    return agrees(on_curve, better_, p, amplitude(curve.reduced_model(), on_curve),
                  std::max(options_.accuracy, change_));
}

bool CurveCompression::confirms_stability(const Branch &curve) {
    const auto &points = curve.points();
    vector<std::size_t> at = beside_changes(points);
    at.push_back(static_cast<std::size_t>(largest_response(curve)));
    const auto agrees =
        is_dear(*whole_) ? &CurveCompression::agrees_on_better : &CurveCompression::agrees_on_whole;
    doubtful_.clear();
    for (std::size_t i : at) {
        if (!points[i].motion || stability_of(points[i]) < 0 ||
            (this->*agrees)(curve, static_cast<std::int64_t>(i)))
            continue;
        doubtful_ =
            format("stability at %.6g Hz is not as on the compressed model", points[i].omega / (2 * M_PI));
        watch_.log(1, doubtful_);
        return is_dear(*whole_) || !grow_at(curve.reduced(), points[i]); // nothing else is at hand: warn()
    }
    return true;
}

void CurveCompression::warn(Branch &curve) const {
    const Watch keeping = watch_.keeping(curve.warnings);
    const std::string dear =
        "so many pairs open and close that a nearer curve takes many minutes. Set motion to "
        "exact for a curve on the whole basis, or n_harmonics for one by harmonic balance";
    const double hz = curve.points()[static_cast<std::size_t>(largest_response(curve))].omega / (2 * M_PI);
    if (!std::isfinite(change_))
        keeping.warn(
            reason::unverified,
            format("this curve of exact motions was followed on %lld of the basis' %lld coordinates, and "
                   "what more "
                   "of them would change at its highest point, %.6g Hz, was not found with the effort "
                   "allowed. Raise "
                   "the effort of the context, or set motion to exact for a curve on the whole basis",
                   static_cast<long long>(curve.reduced().size()), static_cast<long long>(whole_->size()),
                   hz));
    else if (change_ > options_.accuracy)
        keeping.warn(
            reason::basis_too_small,
            format("this curve of exact motions was followed on %lld of the basis' %lld coordinates, "
                   "and at its highest point, %.6g Hz, %lld of them change the amplitude by %.2g of "
                   "itself (accuracy %.2g): %s",
                   static_cast<long long>(curve.reduced().size()), static_cast<long long>(whole_->size()), hz,
                   static_cast<long long>(better_->size()), change_, options_.accuracy, dear.c_str()));
    if (!doubtful_.empty())
        keeping.warn(
            reason::unverified,
            format("%s (%lld of the basis' %lld coordinates), or no motion was found there on a larger "
                   "one: stability flags near there are not certain. Set motion to exact for a curve on "
                   "the whole basis",
                   doubtful_.c_str(), static_cast<long long>(curve.reduced().size()),
                   static_cast<long long>(whole_->size())));
}

} // namespace plm
