// What a method of a study is made from: the options of sampler, basis and solver, copied, so that everything
// can be made anew and timed.
#pragma once
#include "reduction/basis.hpp"
#include "searches/hbm.hpp"
#include <optional>

namespace plm {

/// First reduction under piecewise-linear modes (paper, 2.3.4).
struct ParentRecipe {
    BasisOptions basis;
    std::optional<SamplerOptions> sampler;
};

struct Recipe {
    std::optional<SamplerOptions> sampler;
    std::shared_ptr<const ParentRecipe> parent; // kind plm only, or null
    BasisOptions basis;
    HbmOptions hbm;
};

/// The study's accuracy for a solver whose host has set none.
void take_accuracy(double accuracy, HbmOptions &hbm);

struct FrequencyRange {
    double low_hz = 0, high_hz = 0;
};

/// The functions below take the contact space known so far, or null, and leave the one they used there: it is
/// made where none is known or more is needed.
using KnownSpace = std::shared_ptr<const Space>;

/// The recipe without what is no part of the method's own work: a sampler that only gives the window to a
/// basis of another kind than plm is run here, and its window is written into the basis' options.
Recipe with_window(const std::shared_ptr<const Model> &model, const Recipe &recipe, Watch watch,
                   KnownSpace &space);

/// Where the curve of a recipe of with_window() is followed: its solver's range, or its basis' window.
FrequencyRange range_of(const std::shared_ptr<const Model> &model, const Recipe &recipe, Watch watch,
                        KnownSpace &space);

/// Sampler and basis anew, with nothing shared with earlier ones besides the model, its factorization and
/// `space`.
std::shared_ptr<const Basis> build(const std::shared_ptr<const Model> &model, const Recipe &recipe,
                                   Watch watch, KnownSpace &space);

/// The contact space a basis or its sampler was made in; null: none (Craig-Bampton).
KnownSpace contact_space_of(const Basis &basis);
/// What its arrays hold.
std::int64_t bytes_of(const Space &space);

} // namespace plm
