// What a study is asked for: the methods, each a way to a response curve.
#pragma once
#include "orbits/transient.hpp"
#include "study/plane_curve.hpp"
#include "study/recipe.hpp"

namespace plm {

struct StudyOptions {
    std::int64_t repeats = 3;          // timed runs of each method, after one to warm up; 0: that one
    std::int64_t curve_samples = 1000; // points of the reference, equally spaced in arc length
    double accuracy = 1e-3;            // of the methods' curves; the reference is better by a decade
    double curve_tolerance = 0;        // distance of a curve from its cubic pieces; 0: by accuracy
    bool share_space = true; // the contact space is made once; its time is added to every method that uses it

    /// Far below the errors looked for, unless set.
    double resolved_curve_tolerance() const {
        return curve_tolerance > 0 ? curve_tolerance : 5e-4 * accuracy;
    }
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

} // namespace plm
