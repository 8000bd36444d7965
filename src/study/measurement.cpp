#include "study/measurement.hpp"
#include "motions/responses.hpp"
#include "orbits/make_transient.hpp"
#include "sampling/dominant_mode.hpp"
#include "searches/refinement.hpp"
#include <algorithm>
#include <chrono>

namespace plm {
namespace {

class Stopwatch {
  public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin_ = Clock::now();
};

using BranchPtr = std::shared_ptr<const Branch>;

BranchPtr sweep(const Basis &basis, const HbmOptions &options, Watch watch) {
    BranchPtr branch =
        Hbm(basis.reduced(), basis.window_min_hz(), basis.window_max_hz(), options, watch).sweep();
    require_unstopped(*branch);
    return branch;
}

class Run {
  public:
    Run(const MethodPlan &method, const MeasurementCase &where, Watch watch)
        : method_(method), where_(where), watch_(watch) {}

    Measurement result() {
        if (method_.kind == MethodKind::marching)
            march();
        else
            follow();
        return std::move(out_);
    }

  private:
    void follow() {
        const Stopwatch setup;
        build_basis();
        if (method_.kind == MethodKind::compressed) compress_basis();
        if (method_.kind == MethodKind::refined) refine_basis();
        out_.setup_seconds = setup.seconds();
        out_.size = out_.basis->reduced()->size();
        const Stopwatch curve;
        for (double level : where_.levels)
            out_.curves.push_back(sweep(*out_.basis, options_at_level(method_, where_, level), watch_));
        out_.curve_seconds = curve.seconds();
        Warnings said = out_.basis->report().warnings;
        for (const BranchPtr &b : out_.curves) said.add(b->warnings);
        const std::string text = unmeasured_text(said);
        if (!text.empty()) out_.note += (out_.note.empty() ? "" : "; ") + text;
        NewtonWork work;
        for (const BranchPtr &b : out_.curves) work += b->newton_work;
        out_.iteration_seconds =
            work.seconds / static_cast<double>(std::max<std::int64_t>(1, work.iterations));
    }

    void build_basis() {
        KnownSpace space = where_.space;
        out_.basis = build(where_.model, method_.recipe, watch_, space);
        out_.space = contact_space_of(*out_.basis);
        if (out_.space && out_.space != where_.space)
            out_.space_seconds = out_.space->seconds - (where_.space ? where_.space->seconds : 0);
    }

    void compress_basis() {
        std::vector<BranchPtr> responses;
        for (double level : outermost_levels(where_))
            responses.push_back(sweep(*out_.basis, options_at_level(method_, where_, level), watch_));
        const Responses motions = responses_of(responses);
        BasisOptions o = method_.recipe.basis;
        o.kind = &basis_kinds::pod;
        o.pod_size = method_.size;
        out_.basis = std::make_shared<const Basis>(where_.model, out_.basis->sampler(), out_.basis, o, watch_,
                                                   &motions);
    }

    void refine_basis() {
        RefinementOptions o;
        o.hbm = options_at_level(method_, where_, outermost_levels(where_).back());
        o.output = where_.output;
        o.tolerance = method_.tolerance;
        Refinement found = refine(out_.basis, o, watch_);
        if (!found.basis)
            throw Error(status::convergence, "no curve could be computed on a compressed basis");
        if (!found.met)
            out_.note = format("the tolerance %g was not met in %lld curves, %.2g is left", method_.tolerance,
                               static_cast<long long>(found.rounds), found.error);
        out_.basis = std::move(found.basis);
    }

    void march() {
        const Stopwatch setup;
        if (method_.reduced) build_basis();
        const auto reduced = out_.basis ? out_.basis->reduced() : nullptr;
        std::unique_ptr<Transient> motion = make_transient(where_.model, reduced);
        out_.setup_seconds = setup.seconds();
        out_.size = motion->size();
        const Stopwatch curve;
        for (double level : where_.levels) {
            if (!out_.marched.empty()) motion = make_transient(where_.model, reduced); // from rest again
            out_.marched.push_back(march_curve(*motion, method_.transient, where_.output, where_.range,
                                               method_.n_frequencies, level * method_.transient.force_scale,
                                               watch_));
        }
        out_.curve_seconds = curve.seconds();
        std::int64_t unsettled = 0;
        for (const MarchedCurve &c : out_.marched) unsettled += c.unsettled;
        if (unsettled > 0)
            out_.note =
                format("%lld motions had not settled after %lld periods", static_cast<long long>(unsettled),
                       static_cast<long long>(method_.transient.periods));
    }

    const MethodPlan &method_;
    const MeasurementCase &where_;
    Watch watch_;
    Measurement out_;
};

} // namespace

std::string unmeasured_text(const Warnings &warnings) {
    Warnings said;
    for (const Warning &w : warnings.list())
        if (w.reason != reason::basis_too_small && w.reason != reason::harmonics_too_few)
            said.add(w.reason, w.text);
    return said.text();
}

HbmOptions options_at_level(const MethodPlan &method, const MeasurementCase &where, double level) {
    HbmOptions o = method.recipe.hbm;
    o.force_scale *= level;
    // No error that a study measures asks for it, and the unreduced reference goes without.
    if (o.stability == StabilityKind::automatic) o.stability = StabilityKind::off;
    if (!(o.frequency_min_hz > 0)) o.frequency_min_hz = where.range.low_hz;
    if (!(o.frequency_max_hz > 0)) o.frequency_max_hz = where.range.high_hz;
    return o;
}

std::vector<double> outermost_levels(const MeasurementCase &where) {
    const auto [low, high] = std::minmax_element(where.levels.begin(), where.levels.end());
    if (*low == *high || is_homogeneous(*where.model)) return {*high};
    return {*low, *high};
}

Measurement measure(const MethodPlan &method, const MeasurementCase &where, Watch watch) {
    return Run(method, where, watch).result();
}

namespace {

std::string end_of(const Measurement &m) {
    std::string text;
    for (std::size_t level = 0; level < m.curves.size(); ++level) {
        const std::string end = end_text(m.curves[level]->end_reason);
        if (m.curves[level]->end_reason == reason::range_end) continue;
        text += (text.empty() ? "" : "; ") + format("level %zu: ", level) + end;
    }
    if (!m.note.empty()) text += (text.empty() ? "" : "; ") + m.note;
    return text.empty() ? end_text(reason::range_end) : text;
}

bool reached_the_end(const Measurement &m) {
    return m.note.empty() && std::all_of(m.curves.begin(), m.curves.end(),
                                         [](const auto &b) { return b->end_reason == reason::range_end; });
}

} // namespace

void describe(const Measurement &m, MethodResult &r) {
    r.basis_size = m.size;
    r.curves = m.curves;
    for (const auto &branch : m.curves) {
        r.n_points += static_cast<std::int64_t>(branch->points().size());
        r.newton_iterations += branch->newton_work.iterations;
        r.failed_steps += branch->failed_steps;
    }
    for (const MarchedCurve &curve : m.marched) {
        r.n_points += static_cast<std::int64_t>(curve.samples.hz.size());
        r.failed_steps += curve.unsettled;
    }
    r.outcome = end_of(m);
    r.complete = reached_the_end(m);
}

} // namespace plm
