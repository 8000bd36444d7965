// Hill's method: Floquet exponents as eigenvalues of the harmonic-balance equations of a growing perturbation
// exp(mu t) p(t), p with H harmonics. Converges with H to the multipliers of the exact flow, shares nothing
// with them but the contact indicator, and is the cross-check.
#pragma once
#include "motions/branch.hpp"
#include "orbits/flow_model.hpp"

namespace plm {

/// Of the eigenproblem: one call of LAPACK, which takes a second there and knows nothing of the host.
constexpr std::int64_t largest_hill_order = 600;

/// FlowModel::state_size() multipliers over one period of the response, largest modulus first; empty where
/// the eigenproblem, of order (2 H + 1) times as many, would be larger than largest_hill_order. reduced: what
/// the point belongs to, which the flow may have widened.
vector<std::complex<double>> hill_multipliers(const FlowModel &flow, const ReducedModel &reduced,
                                              const BranchPoint &point, std::int64_t period_multiple);

} // namespace plm
