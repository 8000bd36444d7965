// Lagrange multipliers of the host's matrices: DOFs whose rows of K hold the coefficients of constraints.
#pragma once
#include "structure/constraints.hpp"
#include "structure/sparse.hpp"

namespace plm {

/// What the rows of K at these DOFs say of the others, behind the rows that are there. K over all DOFs.
/// PLM_ERR_MATRIX where such a row has stiffness of its own, couples two of them or is empty.
void add_multiplier_rows(const SparseMatrix &k, const vector<std::int64_t> &multipliers,
                         ConstraintRows &rows);
/// Nothing but K may stand at them: PLM_ERR_MATRIX.
void require_none_at(const vector<std::int64_t> &multipliers, const char *name, const SparseMatrix &a);
/// PLM_ERR_ARGUMENT: a force there would be the right-hand side of a constraint.
void require_none_at(const vector<std::int64_t> &multipliers, const char *name, const vector<double> &load);

} // namespace plm
