// The choice of a factorization. Symmetric matrices `a` have both triangles stored; throws plm::Error.
#pragma once
#include "structure/solver/factor.hpp"
#include "structure/solver/matrix_sum.hpp"
#include <string>

namespace plm {

/// PLM_ERR_NOT_POSITIVE_DEFINITE with index() = column where `a` is not.
std::unique_ptr<Factor> make_factor(const SparseMatrix &a, const Solver &solver = {});
/// Number of negative eigenvalues of any `a` (Sylvester's law of inertia), -1 when the solver cannot tell;
/// PLM_ERR_SINGULAR with index() = column at a pivot whose sign tells nothing.
std::int64_t count_negative(const MatrixSum &a, const Solver &solver = {});
/// Of a factor of `a`, whose values do not matter; nothing where the host's solver serves: it alone knows.
std::optional<FactorEstimate> estimate_factor(const SparseMatrix &a, const Solver &solver = {});
/// "CHOLMOD 3.0.14, Eigen 3.4.0": the library's own, the first of them the default.
std::string factor_backends();

} // namespace plm
