// Rest and modes of a model handle, by the contact space it keeps for them or, where that is much more than
// they need, without.
#pragma once
#include "capi/handles.hpp"
#include "space/spaceless.hpp"

namespace plm::capi {

/// Exact in statics, with at least `least_modes` exact open modes, accurate up to `highest_frequency`
/// (rad/s).
const Space &contact_space(ModelHandle &h, double highest_frequency, std::int64_t least_modes);

/// Null where the handle's space is to serve.
std::unique_ptr<Spaceless> spaceless(const ModelHandle &h, std::int64_t n_modes);

/// The n lowest modes of the system in which every pair keeps its state.
struct LowestModes {
    vector<double> values; // rad^2/s^2, at least n
    /// Of the first n.
    Field shapes(std::int64_t n) const;

    std::shared_ptr<const Space> space; // null: found without, as shapes
    Matrix coordinates;                 // in it
    Field vectors;
};
/// without: to find them without a space, or null.
LowestModes lowest_modes(ModelHandle &h, const PairStates &states, std::int64_t n, Spaceless *without);

} // namespace plm::capi
