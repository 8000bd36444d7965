// Hill's method: Floquet exponents as eigenvalues of the harmonic-balance equations of a growing perturbation
// exp(mu t) p(t), p with H harmonics. Converges with H to the multipliers of the exact flow, shares nothing
// with them but the contact indicator, and is the cross-check.
#pragma once
#include "hbm/branch.hpp"
#include "transient/flow_model.hpp"

namespace plm {

/// FlowModel::state_size() multipliers over one period of the response, largest modulus first. Order of the
/// eigenproblem: (2 H + 1) times as many.
vector<std::complex<double>> hill_multipliers(const FlowModel &flow, const BranchPoint &point,
                                              std::int64_t period_multiple);

} // namespace plm
