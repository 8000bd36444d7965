// Static responses of a linear system beside its modes: what the modes that are kept do not carry of them.
// Kept modes and residual responses span the same as kept modes and static responses (MacNeal 1971: residual
// flexibility), and are far from parallel.
#pragma once
#include "space/space.hpp"

namespace plm {

/// Sum over the modes with kept[j] == 0 of phi_j (phi_j . load) / lambda_j, and of what has no mass, for
/// every column of loads (space size x n), of norm 1; rigid-body modes are left out. all: every mode of the
/// system. Loads that the kept modes carry to rounding give no column.
Matrix residual_responses(const SpaceModes &all, const vector<char> &kept, const Matrix &loads);

} // namespace plm
