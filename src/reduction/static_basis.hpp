// The reduction matrix of the static equations, P_0 = [P q_PS] (paper, eq. (9)).
#pragma once
#include "reduction/conditioning.hpp"

namespace plm {

struct StaticBasis {
    bool same = true;        // P_0 = P: nothing to add
    Coordinates coordinates; // of P_0 when not the same
};

/// q_PS: rest displacement in the space's coordinates (zero without pre-load). It is orthogonalised against P
/// and left out when less than 1e-10 of it remains.
StaticBasis make_static_basis(const Space &space, const Coordinates &dynamic, const vector<double> &q_ps);

/// Relative part of q outside the span: paper, eq. (12), in the M-norm (where there is no mass, in that of
/// K).
double relative_remainder(const Coordinates &dynamic, const vector<double> &q);

} // namespace plm
