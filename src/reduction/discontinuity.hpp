// Linear modes with discontinuous basis vectors (Segalman 2007, Journal of Computational and Nonlinear
// Dynamics 2, 249-266): the modes of a linear reference system are smooth across a joint; each joint adds the
// static field of least energy that has a jump there (Milman and Chu 1994), which for a unit jump of pair i
// is K_ref^-1 B_i^T / (B_i K_ref^-1 B_i^T).
//
// The reference system has the contact as it is at rest; where neither pre-load nor initial gap decides that,
// every pair acts, as in the sliding system. A joint here is one contact pair. Fewer vectors than pairs are
// the softest jump patterns: eigenvectors of the flexibility B K_ref^-1 B^T with the largest values, which is
// their energy under patterns of unit forces.
#pragma once
#include "reduction/mode_selection.hpp"

namespace plm {

struct DiscontinuousModes {
    Matrix columns; // modes kept, then the discontinuity vectors (beside the modes), mass-normalised
    std::int64_t n_modes = 0;
    PairStates reference;  // of the reference system
    vector<double> energy; // Z: eigenvalues of the flexibility, descending, over the largest
};

/// n_vectors: 0 for one per pair, else the leading ones, at most Z. Throws PLM_ERR_ARGUMENT when the rule
/// keeps no mode.
DiscontinuousModes discontinuous_modes(const Space &space, const SelectionRule &rule, std::int64_t n_vectors,
                                       Watch watch);

} // namespace plm
