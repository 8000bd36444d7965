#include "study/study.hpp"
#include "linalg/memory_count.hpp"
#include "searches/error_estimate.hpp"
#include "study/measurement.hpp"
#include "study/pareto.hpp"
#include "study/reference_check.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double smallest_error = 1e-9; // below it an amplitude's error is the solver's tolerance
constexpr double of_reference = 0.1;    // of the accuracy: its own error must not show

double worse(double a, double b) {
    return std::isnan(a) || b > a ? b : a;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

/// A level of the reference: all methods are compared with it.
struct Truth {
    Peak peak;
    PlaneScale scale;
    PlaneCurve curve;
    vector<PlanePoint> samples;
};

class Study {
  public:
    Study(std::shared_ptr<const Model> model, const StudyPlan &plan, Watch watch, KnownSpace &known)
        : plan_(plan), watch_(watch),
          known_(known), where_{std::move(model), checked_output(plan), plan.levels, {}, nullptr} {
        if (shared()) where_.space = known;
        out_.shared_space = shared();
    }

    StudyResult result() {
        run_reference();
        for (const MethodPlan &method : plan_.methods) {
            out_.methods.push_back(out_.cancelled ? not_run(method) : row(method));
            ++n_done_;
        }
        mark_front();
        return std::move(out_);
    }

  private:
    static Output checked_output(const StudyPlan &plan) {
        if (plan.methods.empty())
            throw Error(status::state, "the study has no method; add one first, a response, a compressed or "
                                       "refined basis or marching")
                .argument("study");
        if (!plan.output)
            throw Error(status::state, "the study does not know the motion to look at; set its output first")
                .argument("study");
        return *plan.output;
    }

    bool shared() const { return plan_.options.share_space; }

    // A method's contact space is the next one's, too.
    void keep(const KnownSpace &space) {
        if (shared() && space) where_.space = known_ = space;
    }

    Recipe windowed(const Recipe &recipe) {
        KnownSpace space = where_.space;
        Recipe r = with_window(where_.model, recipe, watch_, space);
        keep(space);
        return r;
    }

    // Shared: what making the space took is in the set-up of every method, once and by one measurement.
    double setup_of(const Measurement &m) const {
        if (!shared() || !m.space) return m.setup_seconds;
        return m.setup_seconds - m.space_seconds + m.space->seconds;
    }

    double progress() const {
        return static_cast<double>(n_done_) / static_cast<double>(1 + plan_.methods.size());
    }

    MethodPlan reference_plan() const {
        if (plan_.reference) return *plan_.reference;
        for (const MethodPlan &method : plan_.methods) {
            if (method.kind == MethodKind::marching) continue;
            MethodPlan truth = method;
            truth.options_text = "the unreduced structure, else as \"" + method.name + "\"";
            truth.kind = MethodKind::response;
            truth.recipe.parent.reset();
            truth.recipe.basis.kind = &basis_kinds::full;
            return truth;
        }
        throw Error(status::state,
                    "methods that march in time give no reference; set the reference of the study")
            .argument("reference");
    }

    void run_reference() {
        watch_.step("study", progress());
        MethodPlan plan = reference_plan();
        plan.name = "reference";
        plan.recipe = windowed(plan.recipe);
        take_accuracy(of_reference * plan_.options.accuracy, plan.recipe.hbm);
        KnownSpace space = where_.space;
        where_.range = range_of(where_.model, plan.recipe, watch_, space);
        keep(space);
        MethodResult &r = out_.reference;
        r.name = plan.name, r.options_text = plan.options_text;
        const Measurement m = measured_once(plan, r);
        r.setup_seconds = setup_of(m), r.curve_seconds = m.curve_seconds;
        r.iteration_seconds = m.iteration_seconds;
        describe(m, r);
        for (std::size_t level = 0; level < plan_.levels.size(); ++level) add_truth(plan, m, level);
        for (std::size_t level = 0; level < truth_.size(); ++level) note_peak(truth_[level].peak, level, r);
        r.peak_hz = truth_[0].peak.frequency_hz, r.peak_amplitude = truth_[0].peak.amplitude;
        out_.space_error = m.basis->space()->error_estimate;
        out_.range = where_.range;
        out_.levels = plan_.levels;
        note_harmonics(plan, r);
        r.failed = false;
        ++n_done_;
        watch_.log(1, format("study: reference with %lld coordinates, peak %.6g at %.6g Hz",
                             static_cast<long long>(r.basis_size), r.peak_amplitude, r.peak_hz));
    }

    void add_truth(const MethodPlan &plan, const Measurement &m, std::size_t level) {
        const HbmOptions o = options_at_level(plan, where_, plan_.levels[level]);
        const Branch &branch = *m.curves[level];
        Truth t;
        t.peak = peak_of(m, o, level);
        if (!(std::abs(t.peak.amplitude) > 0))
            throw Error(status::argument,
                        "the DOF of the output does not move on the reference's curve; name one that does")
                .argument("dof");
        t.scale = {where_.range.high_hz - where_.range.low_hz, std::abs(t.peak.amplitude)};
        t.curve =
            plane_curve(branch, o, where_.output, t.scale, plan_.options.resolved_curve_tolerance(), watch_);
        t.samples = equally_spaced(t.curve.pieces, plan_.options.curve_samples);
        note_resolution(t.curve);
        out_.reference.samples.push_back(samples_of(t.curve, t.scale));
        out_.full_residual = worse(out_.full_residual, t.peak.branch->full_residual(0));
        if (is_outermost(level)) check_reference(branch, t.peak, o);
        truth_.push_back(std::move(t));
    }

    // The check costs as much as the curve.
    bool is_outermost(std::size_t level) const {
        const std::vector<double> outermost = outermost_levels(where_);
        return std::find(outermost.begin(), outermost.end(), plan_.levels[level]) != outermost.end();
    }

    void check_reference(const Branch &branch, const Peak &peak, const HbmOptions &o) {
        try {
            const HarmonicCheck check = check_harmonics(branch, peak, o, where_.output, watch_);
            out_.harmonic_error = worse(out_.harmonic_error, check.amplitude);
            out_.harmonic_shift = worse(out_.harmonic_shift, check.frequency);
        } catch (const Error &e) { // stays not known
            if (e.status() == status::cancelled || e.status() == status::callback) throw;
            watch_.log(2, e.what());
        }
    }

    Peak peak_of(const Measurement &m, const HbmOptions &o, std::size_t level) const {
        return Hbm(m.basis->reduced(), m.basis->window_min_hz(), m.basis->window_max_hz(), o, watch_)
            .find_peak(*m.curves[level], where_.output.dof, where_.output.measure, where_.output.harmonic);
    }

    // A highest point at an end of the curve is compared with another one's resonance.
    static void note_peak(const Peak &peak, std::size_t level, MethodResult &r) {
        const std::string text = unmeasured_text(peak.branch->warnings);
        if (!text.empty()) r.outcome += format("; level %zu: ", level) + text;
    }

    // Harmonics that the host gave are its own affair, and may be those of all methods.
    void note_harmonics(const MethodPlan &plan, MethodResult &r) const {
        if (plan.recipe.hbm.n_harmonics > 0 || !(out_.harmonic_error > plan_.options.accuracy)) return;
        r.outcome +=
            format("; its peak moves by %.2g with twice the harmonics, where \"accuracy\" is %.2g: raise "
                   "max_harmonics of the reference",
                   out_.harmonic_error, plan_.options.accuracy);
        r.complete = false;
    }

    void note_resolution(const PlaneCurve &curve) {
        out_.curve_resolution = std::max(out_.curve_resolution, curve.resolution);
        if (curve.unresolved > 0)
            watch_.log(1, format("study: on %lld pieces of a curve no further point was found",
                                 static_cast<long long>(curve.unresolved)));
    }

    static PlaneSamples samples_of(const PlaneCurve &curve, const PlaneScale &scale) {
        PlaneSamples s;
        const auto add = [&](PlanePoint p) {
            s.hz.push_back(p.x * scale.frequency_hz), s.amplitude.push_back(p.y * scale.amplitude);
        };
        for (const PlanePiece &piece : curve.pieces) add(piece.from);
        if (!curve.pieces.empty()) add(curve.pieces.back().to);
        return s;
    }

    // The first run, whose memory is counted.
    Measurement measured_once(const MethodPlan &method, MethodResult &r) {
        const CountingScope scope;
        Measurement m = measure(method, where_, watch_);
        r.peak_bytes = scope.peak();
        if (m.space && m.space == where_.space) r.peak_bytes += bytes_of(*m.space); // made before, used now
        r.space_seconds = m.space ? m.space->seconds : 0;
        keep(m.space);
        return m;
    }

    static MethodResult named(const MethodPlan &method) {
        MethodResult r;
        r.name = method.name, r.options_text = method.options_text;
        return r;
    }

    static MethodResult not_run(const MethodPlan &method) {
        MethodResult r = named(method);
        r.outcome = "not run: cancelled by the progress callback";
        return r;
    }

    MethodResult row(const MethodPlan &planned) {
        MethodResult r = named(planned);
        try {
            watch_.step("study", progress());
            MethodPlan method = planned;
            method.recipe = windowed(method.recipe);
            take_accuracy(plan_.options.accuracy, method.recipe.hbm);
            const Measurement first = measured_once(method, r);
            describe(first, r);
            repeat(method, first, r);
            compare(method, first, r);
            r.failed = false;
        } catch (const Error &e) {
            if (e.status() == status::cancelled) {
                out_.cancelled = true;
                return not_run(planned);
            }
            return failed(planned, e.what());
        } catch (const std::bad_alloc &) {
            return failed(planned, "out of memory");
        }
        watch_.log(1,
                   format("study: %s: %lld coordinates, set-up %.3g s, curve %.3g s, error of the curve %.2e",
                          r.name.c_str(), static_cast<long long>(r.basis_size), r.setup_seconds,
                          r.curve_seconds, r.curve_error_l2));
        return r;
    }

    MethodResult failed(const MethodPlan &method, const std::string &why) const {
        MethodResult r = named(method);
        r.outcome = why;
        watch_.log(2, "study: " + r.name + ": " + why);
        return r;
    }

    // Medians of the timed runs; the first one is among them where there are no others.
    void repeat(const MethodPlan &method, const Measurement &first, MethodResult &r) const {
        std::vector<double> setup, space, curve, iteration;
        const auto add = [&](const Measurement &m) {
            setup.push_back(setup_of(m)), curve.push_back(m.curve_seconds);
            iteration.push_back(m.iteration_seconds);
            space.push_back(m.space ? m.space->seconds : 0);
        };
        if (plan_.options.repeats == 0) add(first);
        for (std::int64_t k = 0; k < plan_.options.repeats; ++k) {
            watch_.step("study", progress());
            add(measure(method, where_, watch_));
        }
        r.space_seconds = median(space);
        r.setup_seconds = median(setup), r.curve_seconds = median(curve);
        if (method.kind != MethodKind::marching) r.iteration_seconds = median(iteration);
    }

    void compare(const MethodPlan &method, const Measurement &m, MethodResult &r) {
        if (method.kind == MethodKind::marching) {
            for (std::size_t level = 0; level < m.marched.size(); ++level)
                compare_marched(m.marched[level], truth_[level], level, r);
            return;
        }
        std::size_t worst = 0;
        double worst_amplitude = -1;
        std::vector<Peak> peaks;
        for (std::size_t level = 0; level < m.curves.size(); ++level) {
            const HbmOptions o = options_at_level(method, where_, plan_.levels[level]);
            const Truth &truth = truth_[level];
            const Peak &peak = peaks.emplace_back(peak_of(m, o, level));
            note_peak(peak, level, r);
            const double amplitude = compare_peaks(peak.frequency_hz, peak.amplitude, truth, level, r);
            if (amplitude > worst_amplitude) worst_amplitude = amplitude, worst = level;
            const PlaneCurve curve = plane_curve(*m.curves[level], o, where_.output, truth.scale,
                                                 plan_.options.resolved_curve_tolerance(), watch_);
            note_resolution(curve);
            r.samples.push_back(samples_of(curve, truth.scale));
            add_distance(curve_distance(truth.samples, curve.pieces), r);
        }
        estimate(method, m, peaks[worst], worst, r);
    }

    static double compare_peaks(double hz, double amplitude, const Truth &truth, std::size_t level,
                                MethodResult &r) {
        if (level == 0) r.peak_hz = hz, r.peak_amplitude = amplitude;
        const double error = std::abs(amplitude / truth.peak.amplitude - 1);
        r.frequency_error = worse(r.frequency_error, std::abs(hz / truth.peak.frequency_hz - 1));
        r.amplitude_error = worse(r.amplitude_error, error);
        return error;
    }

    static void add_distance(const CurveDistance &d, MethodResult &r) {
        r.curve_error_l2 = worse(r.curve_error_l2, d.rms);
        r.curve_error_max = worse(r.curve_error_max, d.max);
    }

    // Points without a curve between them: how far they are from the reference.
    void compare_marched(const MarchedCurve &marched, const Truth &truth, std::size_t level,
                         MethodResult &r) {
        const PlaneSamples &s = marched.samples;
        vector<PlanePoint> points;
        std::size_t top = 0;
        for (std::size_t k = 0; k < s.hz.size(); ++k) {
            points.push_back({s.hz[k] / truth.scale.frequency_hz, s.amplitude[k] / truth.scale.amplitude});
            if (std::abs(s.amplitude[k]) > std::abs(s.amplitude[top])) top = k;
        }
        compare_peaks(s.hz[top], s.amplitude[top], truth, level, r);
        add_distance(curve_distance(points, truth.curve.pieces), r);
        r.samples.push_back(s);
    }

    // What the method itself would say about its peak at the level where it is worst.
    void estimate(const MethodPlan &method, const Measurement &m, const Peak &peak, std::size_t level,
                  MethodResult &r) const {
        const HbmOptions o = options_at_level(method, where_, plan_.levels[level]);
        try {
            const auto full = unreduced_basis(m.basis, watch_, where_.space)->reduced();
            const ErrorEstimate told =
                ErrorEstimator(full, *peak.branch, o)
                    .estimate(0, where_.output.dof, where_.output.measure, where_.output.harmonic);
            if (!told.complete()) {
                watch_.log(1, "study: " + method.name + ": no estimate: its steps do not contract");
                return;
            }
            const ErrorParts &parts = told.amplitude;
            const double size = std::abs(peak.amplitude);
            r.estimated_error = std::abs(parts.sum()) / size;
            // harmonics that the reference lacks as well are no part of the difference
            const bool shared =
                peak.branch->points()[0].n_harmonics == truth_[level].peak.branch->points()[0].n_harmonics;
            const double difference = std::abs(truth_[level].peak.amplitude - peak.amplitude) / size,
                         expected = std::abs(shared ? parts.basis + parts.contact : parts.sum()) / size;
            if (difference > smallest_error) r.effectivity = expected / difference;
        } catch (
            const Error &e) { // not known: contacts that do not hold all rigid-body modes, a singular tangent
            if (e.status() == status::cancelled || e.status() == status::callback) throw;
            watch_.log(1, "study: " + method.name + ": no estimate: " + e.what());
        }
    }

    void mark_front() {
        vector<double> time, error;
        for (const MethodResult &r : out_.methods) {
            time.push_back(r.failed ? not_known : r.setup_seconds + r.curve_seconds);
            error.push_back(r.curve_error_l2);
        }
        const vector<char> front = pareto_front(time, error);
        for (std::size_t i = 0; i < front.size(); ++i) out_.methods[i].pareto = front[i];
    }

    const StudyPlan &plan_;
    Watch watch_;
    KnownSpace &known_; // of the caller
    MeasurementCase where_;
    StudyResult out_;
    std::vector<Truth> truth_; // per level
    std::size_t n_done_ = 0;   // methods, the reference counted
};

} // namespace

StudyResult run_study(const std::shared_ptr<const Model> &model, const StudyPlan &plan, Watch watch,
                      KnownSpace &known) {
    return Study(model, plan, watch, known).result();
}

bool study_is_built() {
    return true;
}

} // namespace plm
