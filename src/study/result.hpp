// What a study finds: a row for each method.
#pragma once
#include "study/plane_curve.hpp"
#include "study/recipe.hpp"
#include <limits>

namespace plm {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// One row: times are medians, errors the worst of all levels, relative; NaN: not known.
struct MethodResult {
    std::string name, options_text;
    std::string outcome;   // how it ended, or why it failed
    bool failed = true;    // nothing can be said
    bool complete = false; // every curve reached the end of its range
    std::int64_t basis_size = -1, n_points = 0, newton_iterations = 0, failed_steps = 0, peak_bytes = -1;
    double setup_seconds = not_known, iteration_seconds = not_known, curve_seconds = not_known;
    double space_seconds = not_known;                       // share of setup_seconds: the contact space
    double peak_hz = not_known, peak_amplitude = not_known; // at the first level
    double frequency_error = not_known, amplitude_error = not_known;
    double curve_error_l2 = not_known, curve_error_max = not_known;
    double estimated_error = not_known, effectivity = not_known;
    bool pareto = false;
    std::vector<std::shared_ptr<const Branch>> curves; // per level; none for marching
    std::vector<PlaneSamples> samples; // per level: the curve's points, or those of the resolved curve
};

struct StudyResult {
    FrequencyRange range;
    std::vector<double> levels;
    MethodResult reference;
    std::vector<MethodResult> methods;
    double harmonic_error = not_known,
           harmonic_shift =
               not_known; // of the reference's peak with twice its harmonics; the worse of the end levels
    double space_error = not_known, full_residual = not_known;
    double curve_resolution = 0; // the worst of all curves
    bool shared_space = false;   // StudyOptions::share_space
    bool cancelled = false;      // some methods were not run
};

} // namespace plm
