// The reduced model in which the static directions are free to move: P_0 in the place of P, too. A flow has
// one set of coordinates, and so have exact motions.
#pragma once
#include "reduction/reduced_model.hpp"

namespace plm {

/// `reduced` itself where P_0 = P; otherwise made when first asked for and kept with it.
std::shared_ptr<const ReducedModel> widened(const std::shared_ptr<const ReducedModel> &reduced);

/// The same of one that was read, P_0 of which gives other digits than the parts that it was formed of: with
/// the loads that the widened one had.
void keep_widened(const ReducedModel &reduced, const HarmonicLoads &excitation);
/// Those; of a model with static directions of its own.
const HarmonicLoads &loads_when_widened(const ReducedModel &reduced);

/// The last n coordinates, without mass and without damping of their own, have none with others either, where
/// the damping takes energy at all: their rows and columns of c become zero.
void clear_massless(std::int64_t n, Matrix &c);

/// Of one basis: one is the other, or the other widened, or compressed from either.
bool of_one_basis(const std::shared_ptr<const ReducedModel> &a, const std::shared_ptr<const ReducedModel> &b);

} // namespace plm
