// The choice of a factorization.
#pragma once
#include "structure/solver/factor.hpp"
#include <string>

namespace plm {

/// Factors the symmetric matrix `a` (both triangles stored). `host` may be null. Throws plm::Error.
std::unique_ptr<Factor> make_factor(const SparseMatrix &a, FactorKind kind, const HostSolver *host = nullptr);
/// "CHOLMOD 3.0.14" or "Eigen 3.4.0": what make_factor uses without a host solver.
std::string factor_backend();

} // namespace plm
