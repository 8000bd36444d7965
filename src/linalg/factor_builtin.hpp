// Private to linalg: what factor.cpp chooses from. Exactly one built-in factorization is compiled
// (factor_cholmod.cpp or factor_eigen.cpp).
#pragma once
#include "factor.hpp"

namespace plm {

std::unique_ptr<Factor> make_builtin_factor(const SparseMatrix &a, FactorKind kind);
std::unique_ptr<Factor> make_host_factor(const SparseMatrix &a, FactorKind kind, const HostSolver &host);

/// The two ways in which a factorization breaks down; `column` is the DOF in the order of the caller.
[[noreturn]] void throw_not_positive_definite(std::int64_t column);
[[noreturn]] void throw_singular(std::int64_t column);

} // namespace plm
