// Motions of a compressed model and of the basis that it was made from, one as the other has it.
#pragma once
#include "motions/branch.hpp"

namespace plm {

/// A point of the compressed model in the coordinates of the whole basis, without the motion itself.
BranchPoint uncompressed(const ReducedModel &model, const BranchPoint &point);
/// The other way: the harmonics that come nearest, by their energy. False: the model has directions alike.
bool compress(const ReducedModel &model, const BranchPoint &point, BranchPoint &compressed);
/// Its mean and harmonics, side by side.
Matrix motions_of(const BranchPoint &point);
/// The pairs' springs, weighted by the share of the period in which they act.
vector<double> mean_springs(const ReducedModel &model, const BranchPoint &exact);
/// What the whole basis misses of equilibrium in an exact motion of the compressed model, harmonic by
/// harmonic (the mean first), answered with the contact's springs at their mean over the period. In the whole
/// basis' coordinates.
BranchPoint corrected_on_whole(const ReducedModel &model, const BranchPoint &exact);

/// Modes below so many times the highest frequency of a range stay whole where its motions are compressed:
/// they are those that internal resonances of low order can set in motion, and whose multipliers die out
/// slowly.
constexpr double slow_modes = 3;
/// A compressed model with the directions of one more motion of the basis, as many as leave out this part of
/// it. highest: angular frequency where the range ends.
std::shared_ptr<const ReducedModel> compressed_with(const ReducedModel &smaller, const BranchPoint &exact,
                                                    double highest, double left_out);

} // namespace plm
