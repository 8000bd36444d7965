// Error against run time: methods, each a way to a response curve, are run and timed beside a reference and
// compared with it. This header is all that a caller needs; a build may leave the rest out (PLM_WITH_STUDY).
#pragma once
#include "study/plane_curve.hpp"
#include "study/recipe.hpp"
#include "transient/transient.hpp"
#include <limits>

namespace plm {

struct StudyOptions {
    std::int64_t repeats = 3;          // timed runs of each method, after one to warm up; 0: that one
    std::int64_t curve_samples = 1000; // points of the reference, equally spaced in arc length
    double curve_tolerance = 5e-7;     // distance of a curve from its cubic pieces
    bool share_space = true; // the contact space is made once; its time is added to every method that uses it
};

enum class MethodKind { response, compressed, refined, marching };

struct MethodPlan {
    std::string name;
    std::string options_text; // the recipe's options that are not the defaults, for the report
    MethodKind kind = MethodKind::response;
    Recipe recipe;
    std::int64_t size = 0;          // compressed: columns, 0: by pod_tolerance
    double tolerance = 0;           // refined
    TransientOptions transient;     // marching
    bool reduced = true;            // marching: on the recipe's basis; false: the full model
    std::int64_t n_frequencies = 0; // marching
};

struct StudyPlan {
    StudyOptions options;
    std::optional<Output> output;
    std::vector<double> levels{1.0}; // factors on the force scale of every method
    std::optional<MethodPlan>
        reference; // none: the unreduced structure, else as the first method with a curve by HBM
    std::vector<MethodPlan> methods;
};

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

struct PlaneSamples {
    vector<double> hz, amplitude;
};

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

/// Throws for what no method can do without: an output, a method, a reference that can be solved. A method
/// that fails is a row of the result. PLM_CANCELLED is thrown when there is no reference yet. known: an
/// earlier contact space of the model, or null; with share_space the last one used is left there.
StudyResult run_study(const std::shared_ptr<const Model> &model, const StudyPlan &plan, Watch watch,
                      KnownSpace &known);

/// report.md, table.csv and curve_*.csv in the folder, which is made when its parent exists. PLM_ERR_ARGUMENT
/// when a file cannot be written.
void write_study(const StudyResult &result, const std::string &folder);

bool study_is_built();

} // namespace plm
