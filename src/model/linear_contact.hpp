// The linear systems that contact leaves behind when every pair is replaced by a spring along its normal: a
// contact set (k_n or nothing), or the equivalent linear stiffnesses of linearisation methods.
#pragma once
#include "model/space.hpp"

namespace plm {

/// Modes of diag(lambda) + G^T diag(spring) G in the space's coordinates, ascending, mass-normalised; those
/// below `upper` (rad^2/s^2), or all when upper is infinite. spring: Z, >= 0, 0: the pair is open.
SpaceModes modes_with_springs(const Space &space, const vector<double> &spring, double upper);

/// x (m) becomes (diag(pivot) + G^T diag(spring) G)^-1 x. pivot: m, > 0; gap: G, Z x m; spring: Z, >= 0.
/// Throws PLM_ERR_SINGULAR when two pairs with infinite springs repeat the same gap row.
void solve_with_springs(const vector<double> &pivot, const Matrix &gap, const vector<double> &spring,
                        vector<double> &x);

} // namespace plm
