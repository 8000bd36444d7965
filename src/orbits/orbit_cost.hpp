// What exact motions cost.
#pragma once
#include "motions/options.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

/// Of a flop, what one of a series takes: products with a vector, in lanes.
constexpr double in_series = 0.25;

/// What a step of Newton's method for an exact motion costs, estimated.
double exact_step_flops(const ReducedModel &model, const MotionOptions &options);

/// Whether the structure of the model can be followed in time: its damping has a causal form, and
/// decays_hopelessly() does not stand against it.
bool has_flow(const ReducedModel &model);

/// Whether a period of the slowest mode takes minutes where the flow has to go by series, whose pieces are no
/// longer than the fastest decay: where damping couples the modes, or leaves their eigenvectors no digits.
bool decays_hopelessly(const ReducedModel &model);

} // namespace plm
