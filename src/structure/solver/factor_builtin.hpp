// Private to linalg: what make_factor() chooses from. Exactly one built-in factorization is compiled
// (factor_cholmod.cpp or factor_eigen.cpp).
#pragma once
#include "structure/solver/factor.hpp"

namespace plm {

std::unique_ptr<Factor> make_builtin_factor(const SparseMatrix &a, FactorKind kind);
std::unique_ptr<Factor> make_host_factor(const SparseMatrix &a, FactorKind kind, const HostSolver &host);

} // namespace plm
