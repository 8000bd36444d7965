#include "capi/keys.hpp"
#include "capi/study_results.hpp"

namespace plm::capi {
namespace {

using H = StudyHandle;
using Ints = vector<std::int64_t>;
using Reals = vector<double>;

/// One value per method.
template <class Out, class Member> Key per_method(const char *name, const char *description, Member member) {
    return result<H>(name, description, [member](const H &h) {
        Out out;
        for (const MethodResult &r : last_run(h).methods) out.push_back(r.*member);
        return out;
    });
}

void add_options(std::vector<Key> &keys) {
    using O = StudyOptions;
    keys.insert(
        keys.end(),
        {
            int_option<&O::repeats>("repeats", 0, 1000,
                                    "timed runs of each method, after one to warm up; 0: that one"),
            real_option<&O::accuracy>(
                "accuracy", 1e-12, 0.5,
                "relative error that a method's curve may have, where its hbm has none of its own set; "
                "of the reference: a tenth of it"),
            int_option<&O::curve_samples>(
                "curve_samples", 2, 1e7,
                "points of the reference's curve, equally spaced in arc length, whose "
                "distance to a method's curve is taken"),
            real_option<&O::curve_tolerance>(
                "curve_tolerance", 0, 1e-2,
                "further points are computed on each curve until its interpolation "
                "is nearer than this, in the scale of the errors of curves; 0: 5e-4 of \"accuracy\""),
            int_option<&O::share_space>(
                "share_space", 0, 1,
                "1: the contact space of the model is made once, and its time added to "
                "the set-up of each method that uses it; 0: each run makes its own"),
        });
}

void add_times(std::vector<Key> &keys) {
    using R = MethodResult;
    keys.insert(
        keys.end(),
        {
            result<H>("n_methods", "methods added",
                      [](const H &h) { return static_cast<std::int64_t>(h.plan.methods.size()); }),
            result<H>("n_levels", "force levels",
                      [](const H &h) { return static_cast<std::int64_t>(h.plan.levels.size()); }),
            result<H>("frequency_low_hz", "lower end of the range (Hz)",
                      [](const H &h) { return last_run(h).range.low_hz; }),
            result<H>("frequency_high_hz", "upper end of the range (Hz)",
                      [](const H &h) { return last_run(h).range.high_hz; }),
            per_method<Ints>("basis_size", "coordinates of each method; -1: it failed", &R::basis_size),
            per_method<Reals>("setup_seconds", "median time of all that comes before the curves (s)",
                              &R::setup_seconds),
            per_method<Reals>("space_seconds",
                              "share of it that the contact space took (s); 0: the method needs none",
                              &R::space_seconds),
            per_method<Reals>("curve_seconds", "median time of the curves of all levels (s)",
                              &R::curve_seconds),
            per_method<Reals>("iteration_seconds", "median time of a Newton iteration (s); NaN for marching",
                              &R::iteration_seconds),
            per_method<Ints>(
                "peak_bytes",
                "most memory held at once by the library's arrays and by CHOLMOD, beyond the model's (bytes)",
                &R::peak_bytes),
            per_method<Ints>("n_points", "points of the curves of all levels", &R::n_points),
            per_method<Ints>("newton_iterations", "Newton iterations of all levels", &R::newton_iterations),
            per_method<Ints>("failed_steps",
                             "continuation steps that were repeated, or motions that did not settle",
                             &R::failed_steps),
        });
}

void add_errors(std::vector<Key> &keys) {
    using R = MethodResult;
    keys.insert(
        keys.end(),
        {
            per_method<Reals>("peak_hz", "frequency of the peak at the first level (Hz)", &R::peak_hz),
            per_method<Reals>("peak_amplitude", "the peak at the first level", &R::peak_amplitude),
            per_method<Reals>("frequency_error", "relative error of the peak's frequency, worst level",
                              &R::frequency_error),
            per_method<Reals>("amplitude_error", "relative error of the peak, worst level",
                              &R::amplitude_error),
            per_method<Reals>(
                "curve_error_l2",
                "root mean square distance from the reference's curve over its arc length, frequencies "
                "over the width of the range, amplitudes over the reference's peak; worst level",
                &R::curve_error_l2),
            per_method<Reals>("curve_error_max", "the largest such distance", &R::curve_error_max),
            per_method<Reals>(
                "estimated_error",
                "relative error of the peak as the error estimate says, all causes together, at the "
                "level where the true one is largest",
                &R::estimated_error),
            per_method<Reals>(
                "effectivity",
                "estimated over true error there, without the harmonics where the reference has no more "
                "of them; NaN: the true one is below 1e-9",
                &R::effectivity),
            result<H>("pareto",
                      "1: no other method is both faster (set-up and curve) and nearer (curve_error_l2)",
                      [](const H &h) {
                          Ints out;
                          for (const R &r : last_run(h).methods) out.push_back(r.pareto);
                          return out;
                      }),
        });
}

void add_reference(std::vector<Key> &keys) {
    keys.insert(
        keys.end(),
        {
            result<H>("reference_size", "coordinates of the reference",
                      [](const H &h) { return last_run(h).reference.basis_size; }),
            result<H>("reference_setup_seconds", "time of its set-up, once (s)",
                      [](const H &h) { return last_run(h).reference.setup_seconds; }),
            result<H>("reference_space_seconds", "as space_seconds",
                      [](const H &h) { return last_run(h).reference.space_seconds; }),
            result<H>("reference_curve_seconds", "time of its curves, once (s)",
                      [](const H &h) { return last_run(h).reference.curve_seconds; }),
            result<H>("reference_peak_bytes", "as peak_bytes",
                      [](const H &h) { return last_run(h).reference.peak_bytes; }),
            result<H>("reference_peak_hz", "frequency of its peak at the first level (Hz)",
                      [](const H &h) { return last_run(h).reference.peak_hz; }),
            result<H>("reference_peak_amplitude", "its peak at the first level",
                      [](const H &h) { return last_run(h).reference.peak_amplitude; }),
            result<H>("reference_harmonic_error",
                      "relative change of its peak with twice the harmonics, the worse of the lowest and the "
                      "highest force level; NaN: that was not found",
                      [](const H &h) { return last_run(h).harmonic_error; }),
            result<H>("reference_harmonic_shift", "relative change of the peak's frequency with them",
                      [](const H &h) { return last_run(h).harmonic_shift; }),
            result<H>("reference_space_error",
                      "relative error of the contact receptances of the space its basis was made in; 0: not "
                      "estimated",
                      [](const H &h) { return last_run(h).space_error; }),
            result<H>("reference_full_residual", "residual of its peak in the full equations, worst level",
                      [](const H &h) { return last_run(h).full_residual; }),
            result<H>("curve_resolution_error",
                      "how far the interpolated curves are from the computed ones, the worst of all, in the "
                      "scale of curve_error_max",
                      [](const H &h) { return last_run(h).curve_resolution; }),
        });
}

} // namespace

const std::vector<Key> &study_keys() {
    static const std::vector<Key> keys = [] {
        std::vector<Key> all;
        add_options(all);
        add_times(all);
        add_errors(all);
        add_reference(all);
        for (Key &key : all) key.nan_is_unknown = !key.is_option;
        return all;
    }();
    return keys;
}

} // namespace plm::capi
