#include "searches/phase_resonance.hpp"
#include "hbm/make_system.hpp"
#include "hbm/modes_at_rest.hpp"
#include "hbm/solved_point.hpp"
#include "motions/branch_path.hpp"
#include "motions/periodic_equations.hpp"
#include "motions/response_at_force.hpp"
#include "orbits/orbit_phase.hpp"
#include "reduction/reduced_rest.hpp"
#include "structure/driven_harmonic.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int32_t crossing = -1; // kind of the test function force - force_scale
constexpr double longest_step = 0.05; // of a backbone: extrema of the force come in close pairs
// Where a backbone ends below: upwards what is of interest begins beside the force asked for; downwards it
// comes to nothing, or turns.
constexpr double below_the_force = 0.5, next_to_nothing = 1e-3; // of the force asked for, of the start's
// The start of a backbone, at rest: of the force at which the first pair switches, of the force asked for;
// and what is so much smaller than that that the pair switches at any force.
constexpr double before_switching = 0.5, small_force = 0.1, no_force = 1e-9;
constexpr double about_resonance = 0.02; // relative: a corrected start farther off is another resonance

} // namespace

double phase_of(const ReducedModel &m, const BranchPoint &point, std::int64_t period_multiple) {
    const auto *driven = driven_harmonic(m.excitation);
    if (!driven) return 0;
    const std::int64_t h = driven->first * period_multiple;
    if (2 * h > point.eta.cols()) return 0;
    // q = a - i b and F = F_r + i F_i: Re(F^H q) = F_r . a - F_i . b
    return dot(m.size(), driven->second.real.data(), point.eta.col(2 * h - 2)) -
           dot(m.size(), driven->second.imag.data(), point.eta.col(2 * h - 1));
}

double solution_distance(const BranchPoint &a, const BranchPoint &b) {
    Matrix x = a.eta, y = b.eta;
    const std::int64_t n = std::max(x.cols(), y.cols()) / 2, size = x.rows() * 2 * n;
    set_harmonics(x, n);
    set_harmonics(y, n);
    const double scale = std::max(norm2(size, x.data()), norm2(size, y.data()));
    double change = 0;
    for (std::int64_t i = 0; i < size; ++i) change = std::hypot(change, x.data()[i] - y.data()[i]);
    return std::hypot(scale > 0 ? change / scale : 0.0, a.omega / b.omega - 1);
}

// --- the system

PhaseResonantSystem::PhaseResonantSystem(HbmSystem &inner, const ReducedModel &m,
                                         std::int64_t period_multiple, double omega_reference, double unit)
    : FreeFrequency(omega_reference, unit, inner, 1), phase_(inner.size(), 0.0) {
    const auto *driven = driven_harmonic(m.excitation);
    if (!driven) return;
    const std::int64_t r = m.size(), at = m.static_size() + 2 * (driven->first * period_multiple - 1) * r;
    if (at + 2 * r > inner.size())
        throw Error(
            PLM_ERR_ARGUMENT,
            format("phase resonance is that of harmonic %d of the excitation, which n_harmonics leaves "
                   "out; set n_harmonics to %d or more",
                   driven->first, driven->first))
            .argument("n_harmonics");
    const double force =
        std::hypot(norm2(r, driven->second.real.data()), norm2(r, driven->second.imag.data()));
    const double scale =
        omega_reference * omega_reference / (force > 0 ? force : 1); // like the other equations
    for (std::int64_t j = 0; j < r; ++j) {
        phase_[at + j] = scale * driven->second.real[j];
        phase_[at + r + j] = -scale * driven->second.imag[j];
    }
}

void PhaseResonantSystem::residual(const double *y, double force, double *r) {
    inner_.set_force_scale(force);
    inner_.residual(y, omega_of(y), r);
    r[inner_.size()] = dot(inner_.size(), phase_.data(), y);
}

void PhaseResonantSystem::fill(Border &border) {
    inner_.parameter_derivative(border.columns.data());
    for (std::int64_t i = 0; i < inner_.size(); ++i) border.columns(i, 0) /= unit();
    std::copy(phase_.begin(), phase_.end(), border.rows.data());
}

// --- a path of phase-resonant points

namespace {

// Those of harmonic balance.
class HarmonicPhase final : public PeriodicEquations {
  public:
    HarmonicPhase(const std::shared_ptr<const ReducedModel> &reduced, const HbmOptions &options,
                  const BranchPoint &about)
        : inner_(make_system(reduced, options)) {
        const vector<double> x = unknowns_of(*inner_, about);
        const std::int64_t statics = reduced->static_size();
        const double response = norm2(inner_->size() - statics, x.data() + statics),
                     range = 2 * M_PI * (options.frequency_max_hz - options.frequency_min_hz);
        scale_ = response_at_force(response, about, options);
        system_ = std::make_unique<PhaseResonantSystem>(*inner_, *reduced, options.period_multiple,
                                                        about.omega, scale_ / range);
    }
    double scale() const { return scale_; }
    Residual &residual() override { return *system_; }
    vector<double> unknowns(const BranchPoint &point) const override { return unknowns_of(*system_, point); }
    BranchPoint solved_point(const PathState &at, double residual, std::int64_t iterations) override {
        return plm::solved_point(*system_, at, residual, iterations);
    }
    vector<std::complex<double>> multipliers(const BranchPoint &) override { return {}; }

  private:
    std::unique_ptr<HbmSystem> inner_;
    std::unique_ptr<PhaseResonantSystem> system_;
    double scale_ = 0;
};

} // namespace

struct PhaseResonance::Followed final : public PathOwner {
    Followed(const PhaseResonance &of, const BranchPoint &about)
        : options(of.options_.hbm), watch(of.watch_) {
        low = 2 * M_PI * options.frequency_min_hz, high = 2 * M_PI * options.frequency_max_hz;
        take(of.options_.exact ? std::make_unique<OrbitPhase>(of.reduced_, options, about) : nullptr);
        if (!equations) take(std::make_unique<HarmonicPhase>(of.reduced_, options, about));
    }
    template <class Equations> void take(std::unique_ptr<Equations> of) {
        if (of) scale = of->scale();
        equations = std::move(of);
    }

    void record(const PathPoint &p) override {
        if (p.bifurcation == crossing) result.crossings.push_back(result.branch->points().size());
        BranchPoint point = equations->solved_point({p.x, p.parameter}, p.residual, p.iterations);
        put_place(p, point);
        if (p.bifurcation == crossing) point.bifurcation = PLM_BIFURCATION_NONE;
        point.multipliers = equations->multipliers(point);
        omega = point.omega;
        result.branch->append(std::move(point));
    }
    bool cancelled(double fraction) override {
        watch.step("isolated branches", fraction);
        return false;
    }
    bool rescue(double, vector<double> &) override { return false; }
    void test(const vector<double> &, double force, vector<double> &values) override {
        values = {force - options.force_scale};
    }
    vector<std::int32_t> test_kinds() const override { return {crossing}; }
    bool interrupt() override { return omega < low || omega > high; }

    HbmOptions options;
    Watch watch;
    double low, high, scale = 0, omega = 0;
    std::unique_ptr<PeriodicEquations> equations;
    Backbone result;
};

PhaseResonance::PhaseResonance(std::shared_ptr<const ReducedModel> reduced, const BackboneOptions &options,
                               Watch watch)
    : reduced_(std::move(reduced)), options_(options), watch_(watch) {
    options_.hbm.unknowns =
        NonlinearUnknowns::modal; // the phase is a function of all coordinates, not of the gaps
    if (options_.force_max <= 0) options_.force_max = 8 * options_.hbm.force_scale;
}

bool PhaseResonance::correct(double force, BranchPoint &point) const {
    const Followed path(*this, point);
    vector<double> y = path.equations->unknowns(point);
    const NewtonOutcome out = newton_at(path.equations->residual(), newton_limits(options_.hbm), y, force);
    if (!out.converged) return false;
    BranchPoint found = path.equations->solved_point({y, force}, out.residual, out.iterations);
    if (!(found.omega > 0)) return false;
    point = std::move(found);
    return true;
}

Backbone PhaseResonance::follow(const BranchPoint &start, bool upward, double low) const {
    Followed path(*this, start);
    path.result.branch =
        std::make_shared<Branch>(reduced_, options_.hbm.force_scale, options_.hbm.period_multiple);
    PathOptions range = path_options(options_.hbm, low, options_.force_max);
    range.upward = upward;
    range.max_step = std::min(longest_step, options_.hbm.max_step);
    range.locate = true;
    PathStart from;
    from.at = {path.equations->unknowns(start), start.force_scale};
    from.scale = path.scale;
    Branch &branch = *path.result.branch;
    take_outcome(follow_path(path.equations->residual(), range, from, path), branch);
    if (branch.end_reason == PLM_REASON_NONE) branch.end_reason = PLM_REASON_RANGE_END;
    branch.unknowns_used = options_.exact ? "state" : "modal";
    return path.result;
}

Backbone PhaseResonance::upward_from(const BranchPoint &start) const {
    return follow(start, true, below_the_force * std::min(start.force_scale, options_.hbm.force_scale));
}

Backbone PhaseResonance::onward(const BranchPoint &point) const {
    return follow(point, true, next_to_nothing * point.force_scale);
}

Backbone PhaseResonance::through(const BranchPoint &point) const {
    const Backbone down = follow(point, false, next_to_nothing * point.force_scale), up = upward_from(point);
    Backbone all{joined(*down.branch, *up.branch), {}};
    const std::size_t joint = down.branch->points().size() - 1;
    for (std::size_t i : down.crossings)
        if (i > 0) all.crossings.push_back(joint - i);
    std::sort(all.crossings.begin(), all.crossings.end());
    if (point.force_scale == options_.hbm.force_scale) all.crossings.push_back(joint);
    for (std::size_t i : up.crossings) all.crossings.push_back(joint + i);
    return all;
}

// --- where backbones begin

// Linear responses about rest at the undamped frequencies inside the range, strongest first.
std::vector<BranchPoint> PhaseResonance::linear_resonances() const {
    const ReducedModel &m = *reduced_;
    const vector<double> coupling = coupling_at_rest(m);
    const auto *driven = driven_harmonic(m.excitation);
    if (!driven || driven->first > options_.hbm.n_harmonics) return {};
    const vector<double> lambda = modes_at_rest(m, coupling).values;
    const auto system = make_system(reduced_, options_.hbm);
    std::vector<BranchPoint> points;
    vector<double> x(system->size());
    for (double l : lambda) {
        const double omega = std::sqrt(std::max(0.0, l)) / driven->first;
        if (omega < 2 * M_PI * options_.hbm.frequency_min_hz ||
            omega > 2 * M_PI * options_.hbm.frequency_max_hz)
            continue;
        system->linear_response(coupling, omega, x.data());
        BranchPoint point;
        system->to_point(x.data(), omega, point);
        double force = 0;
        if (!linear_range(coupling, point, force)) continue;
        for (std::int64_t i = 0; i < point.eta.cols() * m.size(); ++i)
            point.eta.data()[i] *= force / point.force_scale;
        point.force_scale = force;
        points.push_back(std::move(point));
    }
    return points;
}

// A force at which no pair changes its state yet. False when there is none: pairs that touch without
// pressure.
bool PhaseResonance::linear_range(const vector<double> &coupling, const BranchPoint &point,
                                  double &force) const {
    const ReducedModel &m = *reduced_;
    const double asked = options_.hbm.force_scale;
    double largest = 1e300;
    vector<double> mean = m.contact.unloaded_penetration();
    if (m.n_pairs() > 0) gemv('N', 1.0, m.gap_0, point.eta_0.data(), 1.0, mean.data());
    const Matrix u = product('N', 'N', m.gap, point.eta);
    double most = 0;
    for (std::int64_t i = 0; i < m.n_pairs(); ++i) {
        double swing = 0;
        for (std::int64_t c = 0; c < u.cols(); ++c) swing = std::hypot(swing, u(i, c));
        if (swing > 0)
            largest = std::min(largest, coupling[i] == 0.5 ? 0.0 : asked * std::abs(mean[i]) / swing);
        most = std::max(most, swing);
    }
    force = std::min(before_switching * largest, small_force * asked);
    return force > no_force * asked;
}

std::vector<Backbone> PhaseResonance::backbones() const {
    std::vector<Backbone> all;
    for (BranchPoint start : linear_resonances()) {
        const double omega = start.omega;
        if (!correct(start.force_scale, start) || std::abs(start.omega / omega - 1) > about_resonance)
            continue;
        all.push_back(upward_from(start));
    }
    return all;
}

// Between two points of the curve at which the phase changes its sign, Newton's method from the chord.
std::vector<BranchPoint> PhaseResonance::on_curve(const Branch &curve) const {
    std::vector<BranchPoint> found;
    const auto &points = curve.points();
    const std::int64_t multiple = options_.hbm.period_multiple;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double left = phase_of(*reduced_, points[i - 1], multiple),
                     right = phase_of(*reduced_, points[i], multiple);
        if (!(left * right <= 0) || left == right) continue;
        const double t = left / (left - right);
        BranchPoint p = between(points[i - 1], points[i], t);
        if (!correct(curve.force_scale(), p)) continue;
        found.push_back(std::move(p));
    }
    return found;
}

} // namespace plm
