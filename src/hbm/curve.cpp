#include "hbm/curve.hpp"
#include "hbm/formulation.hpp"
#include "hbm/stability.hpp"
#include "hbm/start.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t first_harmonics = 5;
constexpr std::int64_t patience = 5; // points between changes to something cheaper

PathOptions path_options(const HbmOptions &o) {
    PathOptions p;
    p.low = 2 * M_PI * o.frequency_min_hz;
    p.high = 2 * M_PI * o.frequency_max_hz;
    p.upward = o.upward;
    p.tolerance = o.tolerance;
    p.max_iterations = o.max_iterations;
    p.max_points = o.max_points;
    p.initial_step = o.initial_step;
    p.min_step = o.min_step;
    p.max_step = o.max_step;
    p.locate = o.bifurcations;
    return p;
}

std::int64_t highest_excitation(const ReducedModel &m) {
    return m.excitation.empty() ? 1 : std::max(1, m.excitation.rbegin()->first);
}

// Allowed share of the next harmonics in the motion of the gaps, as a multiple of harmonic_tolerance: local
// motions of the surfaces that hardly act back on the structure may be left coarse, but not unresolved.
constexpr double tail_allowance = 20;

// The number of harmonics a point asks for, from what it has; `error`: harmonic_error().
std::int64_t next_harmonics(const HbmOptions &limits, std::int64_t fewest, std::int64_t now,
                            const HarmonicContent &content, double error) {
    const std::int64_t most = std::max(limits.max_harmonics, now);
    const double over = std::max(error, content.tail / tail_allowance) / limits.harmonic_tolerance;
    if (over > 30) return std::min(most, 2 * now);
    if (over > 1) return std::min(most, std::max(now + 2, (7 * now + 4) / 5));
    // without the upper two fifths the tail would grow from `tail` to `tail + top`, and its effect with it
    const double grows = content.tail > 0 ? 1 + content.top / content.tail : 1;
    if (over * grows < 0.3 && content.tail + content.top < 0.3 * tail_allowance * limits.harmonic_tolerance)
        return std::max(fewest, now - (2 * now) / 5);
    return now;
}

class CurveTracer final : public PathOwner {
  public:
    CurveTracer(const HbmOptions &options, Watch watch, Branch &branch)
        : asked_(options), options_(options), watch_(watch), branch_(branch),
          reduced_(branch.reduced_model()), stability_(reduced_, options),
          fewest_(std::max<std::int64_t>(3, highest_excitation(*reduced_))) {}

    void run(const CurveStart &start) {
        options_.n_harmonics = start.point.n_harmonics / options_.period_multiple;
        wants_modal_ = modal_ = prefers_modal(*reduced_, options_);
        options_.unknowns = modal_ ? UnknownSpace::modal : UnknownSpace::gaps;
        compliant_ = make_formulation(*reduced_, options_).compliant;
        branch_.space_used = modal_ ? "modal" : "gaps";
        system_ = make_system(reduced_, options_);
        try {
            follow(path_options(options_), first(start));
        } catch (const Error &e) { // stopped in the middle of a point: those found so far stay valid
            if (e.status() != PLM_CANCELLED || n_points() == 0) throw;
            branch_.end_reason = PLM_REASON_CANCELLED;
        }
    }

    void record(const PathPoint &p) override {
        BranchPoint point;
        point.residual = p.residual;
        point.iterations = p.iterations;
        point.arclength = base_arclength_ + p.arclength;
        point.bifurcation = p.bifurcation;
        point.force_scale = options_.force_scale;
        system_->to_point(p.x.data(), p.parameter, point);
        point.n_switching = system_->indicator().n_switching;
        if (stability_.wanted()) point.multipliers = multipliers(p.x, p.parameter);
        look_at_harmonics(p.x, point);
        moved_most_ = std::max(moved_most_, point.n_switching);
        branch_.append(std::move(point));
    }

    bool cancelled(double fraction) override { return cancelled_ || watch_.cancelled("sweep", fraction); }

    bool rescue(double omega, vector<double> &x) override {
        try {
            const StartOutcome out = find_start(*system_, *reduced_, options_, omega, true, watch_, x);
            branch_.newton_iterations += out.iterations;
            branch_.newton_seconds += out.seconds;
            branch_.factorizations += out.factorizations;
            return out.converged;
        } catch (const Error &e) { // the branch found so far stays valid
            if (e.status() != PLM_CANCELLED) throw;
            cancelled_ = true;
            return false;
        }
    }

    vector<std::int32_t> test_kinds() const override {
        if (!stability_.wanted()) return {};
        return {PLM_BIFURCATION_PERIOD_DOUBLING, PLM_BIFURCATION_NEIMARK_SACKER};
    }

    void test(const vector<double> &x, double omega, vector<double> &values) override {
        if (stability_.wanted()) values = bifurcation_tests(multipliers(x, omega));
    }

    bool interrupt() override {
        ++since_change_;
        const bool grow = wanted_harmonics_ > options_.n_harmonics && since_change_ > blocked_;
        rejects_ = grow && n_kept_ > 1 && misleading();
        if (!rejects_) n_kept_ = n_points();
        if (since_change_ < patience) return grow;
        choose_space();
        return grow || wanted_harmonics_ < options_.n_harmonics || wants_modal_ != modal_;
    }

  private:
    void follow(PathOptions limits, PathStart path) {
        for (;;) {
            const PathOutcome out = follow_path(*system_, limits, path, *this);
            count(out);
            if (out.end_reason != PLM_REASON_NONE) break;
            limits.max_points = asked_.max_points - n_points();
            limits.initial_step = out.step;
            path = change_system(out);
        }
    }

    // The last step led to where its harmonics are far too few (contact has just begun to open): its points
    // may not even be near the curve.
    bool misleading() const {
        const double now = branch_.points().back().harmonic_tail,
                     before = branch_.points()[static_cast<std::size_t>(n_kept_ - 1)].harmonic_tail;
        return now > 20 * asked_.harmonic_tolerance && before < 0.3 * now;
    }

    std::int64_t n_points() const { return static_cast<std::int64_t>(branch_.points().size()); }

    void count(const PathOutcome &out) {
        branch_.end_reason = out.end_reason;
        branch_.newton_iterations += out.newton_iterations;
        branch_.newton_seconds += out.newton_seconds;
        branch_.factorizations += out.factorizations;
        branch_.failed_steps += out.failed_steps;
        base_arclength_ += out.arclength;
    }

    PathStart first(const CurveStart &start) {
        PathStart path = leaving(start.point, start.towards.empty() ? start.point : start.towards[0]);
        if (start.towards.empty()) path.direction_x.clear();
        if (start.away) turn_round(path);
        path.residual = start.point.residual;
        return path;
    }

    vector<double> coordinates(const BranchPoint &point) {
        vector<double> x(system_->size());
        system_->from_point(point, x.data());
        return x;
    }

    // The multipliers of the last point asked for are kept: tests and records come in turn.
    const vector<std::complex<double>> &multipliers(const vector<double> &x, double omega) {
        if (omega != known_omega_ || x != known_x_) {
            BranchPoint point;
            point.force_scale = options_.force_scale;
            system_->to_point(x.data(), omega, point);
            known_multipliers_ = stability_.multipliers(point);
            known_x_ = x;
            known_omega_ = omega;
        }
        return known_multipliers_;
    }

    void look_at_harmonics(const vector<double> &x, BranchPoint &point) {
        wanted_harmonics_ = options_.n_harmonics;
        const bool needed = asked_.n_harmonics == 0 || asked_.tail_correction;
        if (!needed && !reduced_->damping.empty()) return; // a dense factorization for each harmonic
        const HarmonicContent content = harmonic_content(*reduced_, point, options_.period_multiple);
        point.harmonic_tail = content.tail;
        if (asked_.n_harmonics == 0) {
            point.harmonic_error =
                harmonic_error(*reduced_, point, options_.period_multiple, content, *system_, x.data());
            wanted_harmonics_ =
                next_harmonics(asked_, fewest_, options_.n_harmonics, content, point.harmonic_error);
        }
        if (!asked_.tail_correction) return;
        point.eta.append(content.tail_response);
    }

    // By the cubic cost of the dense factorization, with some inertia.
    void choose_space() {
        wants_modal_ = modal_;
        if (asked_.unknowns == UnknownSpace::automatic && reduced_->n_pairs() > 0 && !compliant_) {
            const double r = static_cast<double>(reduced_->size()), moving = static_cast<double>(moved_most_);
            if (modal_ && 1.5 * moving < r) wants_modal_ = false;
            if (!modal_ && moving > 1.2 * r) wants_modal_ = true;
        }
        moved_most_ = 0;
    }

    // The last point kept in the new system, corrected across the direction travelled; the old system goes on
    // when that fails.
    PathStart change_system(const PathOutcome &out) {
        since_change_ = 0;
        const PathStart path = resume(out);
        HbmOptions changed = options_;
        changed.n_harmonics = wanted_harmonics_;
        changed.unknowns = wants_modal_ ? UnknownSpace::modal : UnknownSpace::gaps;
        auto next = make_system(reduced_, changed);
        next.swap(system_);
        std::int64_t n = rejects_ ? n_kept_ : n_points();
        PathStart other;
        if (!go_on_from(n, changed.n_harmonics < options_.n_harmonics, other)) {
            next.swap(system_);
            blocked_ = 4 * patience;
            wanted_harmonics_ = options_.n_harmonics;
            wants_modal_ = modal_;
            n_kept_ = n_points();
            return path;
        }
        blocked_ = 0;
        base_arclength_ = branch_.points()[static_cast<std::size_t>(n - 1)].arclength;
        branch_.truncate(n);
        n_kept_ = n;
        if (wants_modal_ != modal_) branch_.space_used = "both";
        options_ = changed;
        modal_ = wants_modal_;
        set_end(other);
        return other;
    }

    // The n-th point in the present system or, when that sees another stability there, one of those before
    // it: otherwise a bifurcation would be passed twice, or not at all. Fewer harmonics have to see the same.
    bool go_on_from(std::int64_t &n, bool fewer, PathStart &path) {
        const std::int64_t last = n;
        if (!go_on_from_point(last, path)) return false;
        if (fewer) return same_stability(last, path);
        PathStart earlier = path;
        for (; n > 2 && n > last - patience; --n) {
            if (branch_.points()[static_cast<std::size_t>(n - 1)].bifurcation != PLM_BIFURCATION_NONE)
                continue;
            if (n < last && !go_on_from_point(n, earlier)) break;
            if (!same_stability(n, earlier)) continue;
            path = earlier;
            return true;
        }
        n = last;
        return true;
    }

    bool go_on_from_point(std::int64_t n, PathStart &path) {
        const BranchPoint &at = branch_.points()[static_cast<std::size_t>(n - 1)];
        path = leaving(at, n > 1 ? branch_.points()[static_cast<std::size_t>(n - 2)] : at);
        path.record = false;
        turn_round(path); // on, not back
        if (n == 1) path.direction_parameter = options_.upward ? 1 : -1;
        return correct(path);
    }

    bool same_stability(std::int64_t n, const PathStart &path) {
        const vector<std::complex<double>> &before =
            branch_.points()[static_cast<std::size_t>(n - 1)].multipliers;
        if (!stability_.wanted() || before.empty()) return true;
        const vector<double> a = bifurcation_tests(before),
                             b = bifurcation_tests(multipliers(path.x, path.parameter));
        for (std::size_t k = 0; k < a.size(); ++k)
            if (a[k] * b[k] < 0) return false;
        return true;
    }

    // Where the curve began, as the present system sees it: a loop has to meet it.
    void set_end(PathStart &path) {
        if (n_points() < 2) return;
        PathStart origin = leaving(branch_.points()[0], branch_.points()[1]);
        if (!correct(origin)) origin = leaving(branch_.points()[0], branch_.points()[1]);
        path.end_x = origin.x;
        path.end_parameter = origin.parameter;
        path.end_direction_x = origin.direction_x;
        path.end_direction_parameter = origin.direction_parameter;
    }

    // At `point`, in the direction of `next`.
    PathStart leaving(const BranchPoint &point, const BranchPoint &next) {
        PathStart path;
        path.x = coordinates(point);
        path.parameter = point.omega;
        path.direction_x = coordinates(next);
        for (std::size_t i = 0; i < path.x.size(); ++i) path.direction_x[i] -= path.x[i];
        path.direction_parameter = next.omega - point.omega;
        return path;
    }

    static void turn_round(PathStart &path) {
        for (double &d : path.direction_x) d = -d;
        path.direction_parameter *= -1;
    }

    PathStart resume(const PathOutcome &out) const {
        PathStart path;
        path.x = out.x;
        path.parameter = out.parameter;
        path.direction_x = out.direction_x;
        path.direction_parameter = out.direction_parameter;
        path.scale = out.scale;
        path.record = false;
        return path;
    }

    bool correct(PathStart &path) {
        const double scale = norm2(system_->size(), path.x.data()),
                     width = 2 * M_PI * (options_.frequency_max_hz - options_.frequency_min_hz);
        vector<double> weight(path.direction_x);
        for (double &w : weight) w /= scale > 0 ? scale * scale : 1;
        const SideCondition side{&weight, path.direction_parameter / (width * width)};
        NewtonLimits limits;
        limits.tolerance = options_.tolerance;
        limits.max_iterations = options_.max_iterations;
        limits.min_damping = 0.01;
        limits.omega_scale = width;
        const vector<double> guess = path.x;
        const double omega = path.parameter;
        const NewtonOutcome out = newton(*system_, side, limits, path.x, path.parameter);
        branch_.newton_iterations += out.iterations;
        branch_.newton_seconds += out.seconds;
        branch_.factorizations += out.factorizations;
        double change = 0;
        for (std::size_t i = 0; i < guess.size(); ++i) change = std::hypot(change, path.x[i] - guess[i]);
        return out.converged && change < 0.3 * scale && std::abs(path.parameter - omega) < 0.1 * width;
    }

    const HbmOptions asked_;
    HbmOptions options_; // with the harmonics and the unknowns of now
    Watch watch_;
    Branch &branch_;
    std::shared_ptr<const ReducedModel> reduced_;
    Stability stability_;
    std::unique_ptr<HbmSystem> system_;
    bool compliant_ = false, modal_ = true, wants_modal_ = true, cancelled_ = false;
    bool rejects_ = false;    // the last step, see misleading()
    std::int64_t n_kept_ = 0; // points up to the last step that was kept
    std::int64_t fewest_, wanted_harmonics_ = 0, since_change_ = 0, blocked_ = 0, moved_most_ = 0;
    double base_arclength_ = 0;
    vector<double> known_x_;
    double known_omega_ = -1;
    vector<std::complex<double>> known_multipliers_;
};

} // namespace

void trace_curve(const HbmOptions &options, const CurveStart &start, Watch watch, Branch &branch) {
    CurveTracer(options, watch, branch).run(start);
}

HbmOptions with_first_harmonics(const ReducedModel &reduced, const HbmOptions &options) {
    HbmOptions first = options;
    if (first.n_harmonics == 0)
        first.n_harmonics =
            std::min(options.max_harmonics, std::max(first_harmonics, highest_excitation(reduced)));
    return first;
}

std::int64_t harmonics_of(const BranchPoint &point, std::int64_t period_multiple) {
    return std::max<std::int64_t>(1, point.n_harmonics / period_multiple);
}

HbmOptions options_at(const BranchPoint &point, const HbmOptions &options) {
    HbmOptions o = options;
    o.n_harmonics = harmonics_of(point, options.period_multiple);
    o.force_scale = point.force_scale;
    if (!point.contact_stiffness) {
        o.formulation = FormulationKind::penalty;
        return o;
    }
    if (o.formulation == FormulationKind::penalty) o.formulation = FormulationKind::automatic;
    if (o.unknowns == UnknownSpace::modal)
        o.unknowns = UnknownSpace::gaps; // all that the compliance form has
    return o;
}

HarmonicContent measure_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                                  BranchPoint &point) {
    const auto system = make_system(reduced, options_at(point, options));
    vector<double> x(system->size()), residual(system->size());
    system->from_point(point, x.data());
    system->residual(x.data(), point.omega, residual.data());
    system->linearize();
    HarmonicContent content = harmonic_content(*reduced, point, options.period_multiple);
    point.harmonic_tail = content.tail;
    point.harmonic_error =
        harmonic_error(*reduced, point, options.period_multiple, content, *system, x.data());
    return content;
}

void settle_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                      BranchPoint &point, Watch watch) {
    const std::int64_t multiple = options.period_multiple;
    HbmOptions now = options;
    for (;;) {
        now.n_harmonics = harmonics_of(point, multiple);
        const HarmonicContent content = measure_harmonics(reduced, now, point);
        std::int64_t more = now.n_harmonics;
        if (options.n_harmonics == 0)
            more = next_harmonics(options, more, more, content, point.harmonic_error);
        if (more <= now.n_harmonics) {
            if (options.tail_correction) point.eta.append(content.tail_response);
            return;
        }
        now.n_harmonics = more;
        const auto system = make_system(reduced, now);
        vector<double> x(system->size());
        system->from_point(point, x.data());
        const StartOutcome out = find_start(*system, *reduced, now, point.omega, true, watch, x);
        if (!out.converged) return;
        point.iterations += out.iterations;
        point.residual = out.residual;
        system->to_point(x.data(), point.omega, point);
        point.n_switching = system->indicator().n_switching;
    }
}

} // namespace plm
