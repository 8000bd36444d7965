// The choice of a factorization.
#pragma once
#include "structure/solver/factor.hpp"
#include <string>

namespace plm {

/// Factors the symmetric matrix `a` (both triangles stored). Throws plm::Error.
std::unique_ptr<Factor> make_factor(const SparseMatrix &a, FactorKind kind, const Solver &solver = {});
/// "CHOLMOD 3.0.14, Eigen 3.4.0": the library's own, the first of them the default.
std::string factor_backends();

} // namespace plm
