#include "searches/compressed_curve.hpp"
#include "motions/compressed_motion.hpp"
#include "motions/effort_budget.hpp"
#include "motions/motion_measures.hpp"
#include "orbits/orbit_cost.hpp"
#include "orbits/orbit_point.hpp"
#include "reduction/compression.hpp"
#include "searches/motion_choice.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t many_coordinates = 30;
// What is left out of the motions, in the energy norm: at first. The amplitudes that follow are nearer.
constexpr double left_out_at_first = 1e-3;
// Where all pairs bounce, their motions have something of every direction, most of it too little to move an
// amplitude: a model grows by no more than this from one to the next.
constexpr double grows = 1.5;
// The same where the whole basis is at hand to compare with: by no more than is needed.
constexpr double grows_beside_whole = 1.1;
constexpr std::int64_t motions_looked_at = 6; // of the first curve, besides its highest
constexpr std::int64_t most_rounds = 6;

bool is_dear_step(const ReducedModel &model, const HbmOptions &options) {
    return exact_step_flops(model, options) > options.dearest_step;
}

} // namespace

bool compresses(const ReducedModel &whole, const HbmOptions &options) {
    return options.motion == MotionKind::automatic && prefers_exact_compressed(whole, options) &&
           whole.same_static && !whole.all_pairs && !whole.from && whole.model &&
           options.period_multiple == 1 && whole.size() >= many_coordinates &&
           exact_step_flops(whole, options) > EffortBudget::step_to_compress;
}

bool is_much_smaller(const ReducedModel &model, const ReducedModel &whole) {
    constexpr double much_smaller = 0.7;
    return static_cast<double>(model.size()) <= much_smaller * static_cast<double>(whole.size());
}

HbmOptions options_on(const ReducedModel &model, HbmOptions options) {
    if (model.from && exact_step_flops(model, options) > EffortBudget::long_step)
        options.tolerance = std::max(options.tolerance, ErrorBudget(options.accuracy).dear_motions());
    return options;
}

CurveCompression::CurveCompression(std::shared_ptr<const ReducedModel> whole, const HbmOptions &options,
                                   double highest, Watch watch)
    : whole_(std::move(whole)), options_(options), highest_(highest), left_out_(left_out_at_first),
      watch_(watch) {}

double compression_tolerance(const ReducedModel &whole, const HbmOptions &options) {
    return ErrorBudget(options.accuracy).compressed(is_dear_step(whole, options));
}

double CurveCompression::tolerance_predicted() const {
    return ErrorBudget(options_.accuracy).compressed_as_predicted(is_dear(*whole_));
}

double CurveCompression::tolerance() const {
    return compression_tolerance(*whole_, options_);
}

bool CurveCompression::is_dear(const ReducedModel &model) const {
    return is_dear_step(model, options_);
}

std::shared_ptr<const ReducedModel> CurveCompression::compressed_after(const ReducedModel *last) const {
    return compressed_to(last ? grows * static_cast<double>(last->size())
                              : static_cast<double>(whole_->size()));
}

std::shared_ptr<const ReducedModel> CurveCompression::compressed_to(double most) const {
    std::vector<vector<double>> springs = needs_.springs;
    springs.push_back(whole_->contact.stiffness);
    return compress_beside_modes(whole_, needs_.motions, springs, omega_, left_out_, slow_modes * highest_,
                                 static_cast<std::int64_t>(most));
}

// point: in the coordinates of the whole basis.
void CurveCompression::take(const BranchPoint &point, Matrix &motions) const {
    Matrix columns = motions_of(point);
    for (std::int64_t k = 0; k < columns.rows() * columns.cols(); ++k) columns.data()[k] /= scale_;
    motions.append(columns);
}

double CurveCompression::amplitude(const std::shared_ptr<const ReducedModel> &model,
                                   const BranchPoint &point) const {
    Branch one(model, options_.force_scale);
    one.append(point);
    return one.amplitude(0, output_.dof, Measure::peak, 0);
}

bool CurveCompression::make_exact_on(const std::shared_ptr<const ReducedModel> &model, BranchPoint &point,
                                     ElseMarching otherwise) const {
    BranchPoint guess;
    NewtonWork work;
    if (!compress(*model, point, guess)) return false;
    if (!make_exact(model, options_on(*model, options_), watch_.quiet(), guess, work, otherwise))
        return false;
    point = std::move(guess);
    return true;
}

void CurveCompression::Needs::append(const Needs &other) {
    motions.append(other.motions);
    springs.insert(springs.end(), other.springs.begin(), other.springs.end());
}

// The exact motion becomes the point's, and what the whole basis answers to its contact forces.
bool CurveCompression::settle(const std::shared_ptr<const ReducedModel> &model, Point &point,
                              ElseMarching otherwise) const {
    BranchPoint exact = point.motion;
    if (!make_exact_on(model, exact, otherwise)) return false;
    const double now = amplitude(model, exact);
    if (point.amplitude >= 0) point.change = std::abs(now - point.amplitude) / peak_;
    point.amplitude = now;
    point.motion = corrected_on_whole(*model, exact);
    point.needs = needs_beside(*model, exact, point.motion);
    point.exact = std::move(exact);
    return true;
}

double CurveCompression::settle(const std::shared_ptr<const ReducedModel> &model,
                                std::vector<Point> &points) const {
    double change = -1;
    std::vector<Point *> missed;
    const auto take_point = [&](Point &point, ElseMarching otherwise) {
        if (!settle(model, point, otherwise)) return false;
        if (std::isfinite(point.change)) change = std::max(change, point.change);
        return true;
    };
    for (Point &point : points) {
        if (point.change <= tolerance() && &point != &points.back())
            change = std::max(change, point.change);
        else if (!take_point(point, ElseMarching::no))
            missed.push_back(&point);
    }
    if (2 * missed.size() > points.size()) // they are worth marching
        for (Point *point : missed) take_point(*point, ElseMarching::yes);
    return change >= 0 ? change : INFINITY;
}

// Motions of the first curve and, of some points of it, what is to settle.
std::vector<CurveCompression::Point> CurveCompression::points_of(const Branch &look) {
    std::vector<Point> points;
    const std::int64_t top = largest_response(look);
    output_ = most_moving(look, top);
    peak_ = look.amplitude(top, output_.dof, Measure::peak, 0);
    omega_ = look.points()[static_cast<std::size_t>(top)].omega;
    for (const BranchPoint &p : look.points())
        scale_ = std::max(scale_, norm2(p.eta.rows() * p.eta.cols(), p.eta.data()));
    if (!(peak_ > 0 && scale_ > 0)) return points;
    for (const BranchPoint &p : look.points()) take(p, needs_.motions);
    vector<std::int64_t> at = spread_over(look, motions_looked_at);
    at.push_back(top);
    for (std::int64_t i : at) {
        points.emplace_back();
        points.back().motion = look.points()[static_cast<std::size_t>(i)];
    }
    return points;
}

bool CurveCompression::saves(const ReducedModel &smaller) const {
    return has_flow(smaller) && is_much_smaller(smaller, *whole_);
}

// Whatever its motions are, no better model would be followed than this one.
bool CurveCompression::is_last_not_dear(const ReducedModel &model) const {
    CurveCompression next(*this);
    next.left_out_ *= ErrorBudget::next_try;
    return is_dear(*next.compressed_after(&model));
}

bool CurveCompression::begin_with(const Branch &look) {
    std::vector<Point> points = points_of(look);
    if (points.empty()) return false;
    const auto is_found = [](const Point &p) { return p.amplitude >= 0; };
    std::shared_ptr<const ReducedModel> before;
    double change = INFINITY;
    for (std::int64_t round = 0; round < most_rounds; ++round) {
        const auto smaller = compressed_after(before.get());
        if (before && is_dear(*smaller)) {
            model_ = before;
            return true;
        }
        if (!saves(*smaller)) {
            model_ = before; // or a curve on the whole one does not end in minutes
            return before &&
                   (change <= ErrorBudget(options_.accuracy).step_to_last_model() || is_dear(*whole_));
        }
        if (before && is_last_not_dear(*smaller)) {
            model_ = smaller;
            return true;
        }
        change = settle(smaller, points);
        Needs needs;
        for (const Point &point : points) needs.append(point.needs);
        // they know more than those before, unless they are few
        if (2 * std::count_if(points.begin(), points.end(), is_found) < motions_looked_at)
            needs.append(needs_);
        needs_ = std::move(needs);
        watch_.log(1, format("compressed to %lld of %lld coordinates: amplitudes change by %.2g of the peak",
                             static_cast<long long>(smaller->size()), static_cast<long long>(whole_->size()),
                             change));
        // the change is what the model before made wrong, this one's error is a part of it
        if (change <= options_.accuracy) {
            model_ = change <= tolerance() ? before : smaller;
            return saves(*model_);
        }
        before = smaller;
        if (round > 0 && !std::isfinite(change)) return false;
        left_out_ *= ErrorBudget::next_try;
    }
    return false;
}

// What compression leaves out is a share of the motions, which are about as large as the force.
void CurveCompression::go_on(const HbmOptions &options, const Branch &curve) {
    const double force = std::abs(options_.force_scale), next = std::abs(options.force_scale);
    const ErrorAtForce before = last_;
    last_ = {force, change_};
    if (better_ != whole_) left_out_ /= ErrorBudget::next_try; // the last one was better than it needed to be
    if (better_ == whole_ && !outgrown_ &&
        foretold(before, last_, next) > ErrorBudget(options_.accuracy).compressed_before_another() &&
        grow_to(tolerance_predicted(), curve))
        last_ = {};
    if (force > 0 && next > 0) scale_ *= next / force;
    options_ = options;
    // what the model leaves out of the motions is known by now, and more digits of them are of no use
    options_.tolerance = std::max(options.tolerance, ErrorBudget(options.accuracy).dear_motions());
}

CurveCompression::Needs CurveCompression::needs_at(const ReducedModel &model,
                                                   const BranchPoint &exact) const {
    return needs_beside(model, exact, model.from ? corrected_on_whole(model, exact) : exact);
}

CurveCompression::Needs CurveCompression::needs_beside(const ReducedModel &model, const BranchPoint &exact,
                                                       const BranchPoint &corrected) const {
    Needs needs;
    needs.springs.push_back(mean_springs(model, exact));
    take(uncompressed(model, exact), needs.motions);
    if (model.from) take(corrected, needs.motions);
    return needs;
}

// From what the curve's own motions ask for, until the motion that the whole basis has at its highest point
// is so near on a model. False: none much smaller than the whole one is.
bool CurveCompression::grow_to(double enough, const Branch &curve) {
    needs_ = needs_at(*whole_, top_on_better_);
    for (std::int64_t i : spread_over(curve, motions_looked_at)) {
        const BranchPoint &p = curve.points()[static_cast<std::size_t>(i)];
        if (p.motion) needs_.append(needs_at(curve.reduced(), p));
    }
    const double amplitude_there = amplitude(whole_, top_on_better_);
    double most = static_cast<double>(model_->size());
    std::int64_t size = 0;
    for (;;) {
        left_out_ *= ErrorBudget::next_try;
        most = std::ceil(grows_beside_whole * most);
        const auto larger = compressed_to(most);
        if (!is_much_smaller(*larger, *whole_) || larger->size() == size) break;
        size = larger->size();
        BranchPoint point = top_on_better_;
        if (!make_exact_on(larger, point, ElseMarching::no)) continue;
        const double change = std::abs(amplitude(larger, point) - amplitude_there) / amplitude_there;
        watch_.log(1, format("%lld of %lld coordinates: the highest motion is off by %.2g of itself",
                             static_cast<long long>(size), static_cast<long long>(whole_->size()), change));
        if (change > enough) continue;
        model_ = larger;
        return true;
    }
    return false;
}

// By what the whole basis answers at one point of a curve. False: such a model saves nothing.
bool CurveCompression::grow_at(const ReducedModel &model, const BranchPoint &point) {
    needs_.append(needs_at(model, point));
    left_out_ *= ErrorBudget::next_try;
    const auto larger = compressed_after(&model);
    if (larger->size() <= model.size() || is_dear(*larger) || !saves(*larger)) return false;
    model_ = larger;
    return true;
}

bool CurveCompression::confirms(const Branch &curve) {
    better_ = nullptr, change_ = INFINITY, outgrown_ = false;
    top_ = largest_response(curve);
    const BranchPoint &exact = curve.points()[static_cast<std::size_t>(top_)];
    if (!exact.motion) return false;
    if (!is_dear(*whole_) && find_on_whole(curve, top_, top_on_better_)) {
        compare_with_whole(curve);
        if (change_ <= ErrorBudget(options_.accuracy).compressed_before_another()) return true;
        outgrown_ = !grow_to(tolerance_predicted(), curve);
        return outgrown_ && change_ <= options_.accuracy;
    }
    std::vector<Point> one(1);
    one[0].motion = uncompressed(curve.reduced(), exact);
    peak_ = one[0].amplitude = amplitude(curve.reduced_model(), exact);
    take(one[0].motion, needs_.motions);
    one[0].motion = corrected_on_whole(curve.reduced(), exact);
    take(one[0].motion, needs_.motions);
    left_out_ *= ErrorBudget::next_try;
    better_ = compressed_after(&curve.reduced());
    change_ = settle(better_, one);
    needs_.append(one[0].needs);
    top_on_better_ = std::move(one[0].exact);
    watch_.log(1, format("%lld of %lld coordinates: the highest motion changes by %.2g of itself",
                         static_cast<long long>(better_->size()), static_cast<long long>(whole_->size()),
                         change_));
    if (change_ <= tolerance()) return true;
    model_ = better_;
    if (std::isfinite(change_)) grow_beside(one);
    return false;
}

// Until its highest motion, which is found at once, changes no more: another whole curve would not be the
// last one before.
void CurveCompression::grow_beside(std::vector<Point> &highest) {
    for (std::int64_t round = 0; round < most_rounds; ++round) {
        CurveCompression next(*this);
        next.left_out_ *= ErrorBudget::next_try;
        const auto larger = next.compressed_after(model_.get());
        if (is_dear(*larger)) return;
        const double change = settle(larger, highest);
        if (change <= tolerance() || !std::isfinite(change)) return;
        watch_.log(1, format("%lld of %lld coordinates: it changes by %.2g more",
                             static_cast<long long>(larger->size()), static_cast<long long>(whole_->size()),
                             change));
        model_ = larger;
        needs_.append(highest[0].needs);
        left_out_ = next.left_out_;
    }
}

double CurveCompression::error() const {
    // What models beyond a better one would change: as much again (the paper's plate with pre-load, on 24
    // coordinates: 2.4e-3 by 36 of them, 5.3e-3 by all).
    constexpr double with_those_beyond = 2;
    return better_ == whole_ ? change_ : with_those_beyond * change_;
}

bool CurveCompression::is_spent() const {
    return better_ && is_dear(*better_) && std::isfinite(change_);
}

} // namespace plm
