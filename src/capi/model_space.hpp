// The contact space a model handle keeps for plm_model_solve_rest and plm_model_get_modes.
#pragma once
#include "capi/handles.hpp"

namespace plm::capi {

/// Exact in statics, with at least `least_modes` exact open modes, accurate up to `highest_frequency`
/// (rad/s).
const Space &contact_space(ModelHandle &h, double highest_frequency, std::int64_t least_modes);

/// The n lowest modes of the system in which every pair keeps its state, in the coordinates of `space`.
struct LowestModes {
    std::shared_ptr<const Space> space;
    SpaceModes modes; // at least n
};
LowestModes lowest_modes(ModelHandle &h, const PairStates &states, std::int64_t n);

} // namespace plm::capi
