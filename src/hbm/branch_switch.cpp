// From a located branch point or period doubling to the curve that crosses or leaves there: the tangent has a
// null vector that does not belong to the curve at hand; a small step along it, corrected across it, is a
// first point of the other one.
#include "hbm/curve.hpp"
#include "hbm/hbm.hpp"
#include "hbm/make_system.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// Null vector of the tangent at x by inverse iteration, of Euclidean length 1.
vector<double> null_vector(HbmSystem &system, const vector<double> &x, double omega) {
    const std::int64_t n = system.size();
    vector<double> v(n), r(n);
    system.residual(x.data(), omega, r.data());
    system.linearize();
    for (std::int64_t i = 0; i < n; ++i)
        v[i] = 0.5 + std::fmod(0.754877666 * static_cast<double>(i + 1), 1.0);
    for (int k = 0; k < 4; ++k) {
        system.solve(v.data(), 1);
        const double size = norm2(n, v.data());
        if (!(size > 0) || !std::isfinite(size))
            throw Error(PLM_ERR_CONVERGENCE, "the tangent's null vector was not found at this point")
                .reason(PLM_REASON_SINGULAR_TANGENT);
        for (double &c : v) c /= size;
    }
    return v;
}

class Switch {
  public:
    Switch(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options, const BranchPoint &origin,
           const BranchPoint &along, bool mirrored)
        : options_(options), width_(2 * M_PI * (options.frequency_max_hz - options.frequency_min_hz)),
          mirrored_(mirrored) {
        options_.n_harmonics = harmonics_of(origin, options.period_multiple);
        options_.unknowns = prefers_modal(*reduced, options) ? UnknownSpace::modal : UnknownSpace::gaps;
        system_ = make_system(std::move(reduced), options_);
        x_ = coordinates(origin);
        omega_ = origin.omega;
        const std::int64_t s = system_->static_size();
        scale_ = norm2(system_->size() - s, x_.data() + s);
        if (scale_ == 0) scale_ = 1;
        set_direction(along);
    }

    // A first point of the other curve and one a little further on.
    bool find(CurveStart &start) {
        for (double step : {1e-2, 3e-2, 1e-1, 3e-3, 1e-3}) {
            vector<double> x;
            double omega = 0;
            if (!corrected(step, x, omega, start.point)) continue;
            BranchPoint further;
            if (!corrected(1.5 * step, x, omega, further)) continue;
            start.towards = {further};
            return true;
        }
        return false;
    }

    std::int64_t iterations() const { return iterations_; }
    double seconds() const { return seconds_; } // of the iterations

  private:
    vector<double> coordinates(const BranchPoint &point) {
        vector<double> x(system_->size());
        system_->from_point(point, x.data());
        return x;
    }

    // The null vector less its share of the curve at hand, of length 1 in the metric of the continuation.
    void set_direction(const BranchPoint &along) {
        direction_ = null_vector(*system_, x_, omega_);
        vector<double> tangent = coordinates(along);
        for (std::size_t i = 0; i < tangent.size(); ++i) tangent[i] = (tangent[i] - x_[i]) / scale_;
        const double tangent_omega = (along.omega - omega_) / width_;
        const std::int64_t n = system_->size();
        const double length = dot(n, tangent.data(), tangent.data()) + tangent_omega * tangent_omega;
        const double share = length > 0 ? dot(n, tangent.data(), direction_.data()) / length : 0;
        for (std::int64_t i = 0; i < n; ++i) direction_[i] -= share * tangent[i];
        direction_omega_ = -share * tangent_omega;
        const double size = std::hypot(norm2(n, direction_.data()), direction_omega_) * (mirrored_ ? -1 : 1);
        for (double &d : direction_) d *= scale_ / size; // in units of x and omega from here on
        direction_omega_ *= width_ / size;
    }

    bool corrected(double step, vector<double> &x, double &omega, BranchPoint &point) {
        const std::int64_t n = system_->size();
        x = x_;
        for (std::int64_t i = 0; i < n; ++i) x[i] += step * direction_[i];
        omega = omega_ + step * direction_omega_;
        vector<double> weight(direction_);
        for (double &w : weight) w /= scale_ * scale_;
        const SideCondition side{&weight, direction_omega_ / (width_ * width_)};
        NewtonLimits limits;
        limits.tolerance = options_.tolerance;
        limits.max_iterations = options_.max_iterations;
        limits.min_damping = 1e-2;
        limits.omega_scale = width_;
        const NewtonOutcome out = newton(*system_, side, limits, x, omega);
        iterations_ += out.iterations;
        seconds_ += out.seconds;
        if (!out.converged || std::abs(omega - omega_) > 0.2 * width_) return false;
        double moved = 0;
        for (std::int64_t i = 0; i < n; ++i) moved = std::hypot(moved, (x[i] - x_[i]) / scale_);
        if (moved > 10 * step) return false; // another solution, far away
        point = BranchPoint();
        point.residual = out.residual;
        point.iterations = out.iterations;
        point.force_scale = options_.force_scale;
        system_->to_point(x.data(), omega, point);
        point.n_switching = system_->indicator().n_switching;
        return true;
    }

    HbmOptions options_;
    double width_, scale_ = 1, omega_ = 0, direction_omega_ = 0;
    bool mirrored_;
    std::unique_ptr<HbmSystem> system_;
    vector<double> x_, direction_;
    std::int64_t iterations_ = 0;
    double seconds_ = 0;
};

} // namespace

std::shared_ptr<const Branch> Hbm::switch_branch(const Branch &branch, std::int64_t point,
                                                 bool mirrored) const {
    const Clock::time_point begin = Clock::now();
    if (branch.reduced_model() != reduced_)
        throw Error(PLM_ERR_ARGUMENT, "the branch belongs to another basis").argument("branch");
    const BranchPoint &origin = branch.points().at(static_cast<std::size_t>(point));
    if (origin.bifurcation != PLM_BIFURCATION_BRANCH_POINT &&
        origin.bifurcation != PLM_BIFURCATION_PERIOD_DOUBLING)
        throw Error(PLM_ERR_ARGUMENT,
                    format("point %lld is neither a branch point nor a period doubling; see the "
                           "branch's \"bifurcation\"",
                           static_cast<long long>(point)))
            .argument("point")
            .index(point);
    const std::int64_t factor = origin.bifurcation == PLM_BIFURCATION_PERIOD_DOUBLING ? 2 : 1;
    HbmOptions options = options_;
    options.period_multiple = factor * branch.period_multiple();
    options.force_scale = origin.force_scale;
    const std::size_t neighbour = static_cast<std::size_t>(point > 0 ? point - 1 : point + 1);
    const BranchPoint &along = branch.points().size() > 1 ? branch.points()[neighbour] : origin;
    Switch other(reduced_, options, on_longer_period(origin, factor), on_longer_period(along, factor),
                 mirrored);
    CurveStart start;
    if (!other.find(start))
        throw Error(PLM_ERR_CONVERGENCE, "no point of another curve was found beside this one")
            .argument("point")
            .reason(PLM_REASON_START_FAILED);
    auto found = std::make_shared<Branch>(reduced_, options.force_scale, options.period_multiple);
    found->newton_iterations = other.iterations();
    found->newton_seconds = other.seconds();
    trace_curve(options, start, watch_, *found);
    finish(*found, begin);
    return found;
}

} // namespace plm
