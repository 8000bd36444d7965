// Galerkin projection of a space onto reduced coordinates (paper, eq. (11)).
#pragma once
#include "reduction/reduced_model.hpp"
#include "reduction/static_basis.hpp"

namespace plm {

struct ProjectedDamping {
    vector<double> diagonal; // or, where it is not diagonal,
    Matrix matrix;
};

/// Of the same structure in every basis, modal damping, too: what the ratios of the space's modes make of
/// other motions.
ProjectedDamping projected_damping(const Space &space, const Coordinates &to);

/// P = V Y, P_0 = V Y_0.
std::shared_ptr<const ReducedModel> project(const Space &space, const Coordinates &dynamic,
                                            const StaticBasis &statics);

/// The whole space as a reduced model: P = P_0 = V.
std::shared_ptr<const ReducedModel> project_whole(const Space &space);

} // namespace plm
