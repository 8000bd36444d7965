// Equilibrium at rest in the coordinates of a reduced model.
#pragma once
#include "reduction/reduced_model.hpp"
#include "space/rest.hpp"

namespace plm {

/// Does anything load it at rest: a pre-load, or a gap below zero?
bool is_loaded_at_rest(const ReducedModel &reduced);
/// Under the pre-load, zero without load; solved when first asked for and kept with the model.
std::shared_ptr<const StaticState> rest_of(const ReducedModel &reduced);

/// Share of the period each pair is closed at rest: 1, 0, or 1/2 for pairs that neither touch nor gap.
vector<double> coupling_at_rest(const ReducedModel &reduced);

} // namespace plm
