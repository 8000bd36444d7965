// A smaller basis from responses: proper orthogonal decomposition of motions computed on a larger one, by
// their energy (Kerschen et al. 2005). Of the unreduced structure's responses it is the classical one; of
// those of piecewise-linear modes it needs no unreduced solution.
#pragma once
#include "reduction/reduced_model.hpp"

namespace plm {

/// Motions in the coordinates of one reduced model; only the size of columns among each other matters.
struct Responses {
    std::shared_ptr<const ReducedModel> of;
    Matrix dynamic;   // r x n: cosine and sine parts of harmonics h >= 1
    Matrix mean;      // r_0 x m: parts of h = 0
    double omega = 0; // a typical frequency (rad/s): weighs kinetic against elastic energy
};

struct Compressed {
    std::shared_ptr<const ReducedModel> reduced;
    vector<double> singular_values; // of the dynamic part, in the energy norm, scaled by the largest
};

/// Keeps as many directions as leave out less than `tolerance` of the responses in the energy norm, or `size`
/// of them when size > 0. P' = P Y, P_0' = P_0 Y_0 with P' in its span, each diagonalised.
Compressed compress(const Responses &responses, double tolerance, std::int64_t size);

} // namespace plm
