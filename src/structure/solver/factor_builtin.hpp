// Private to structure/solver: what make_factor() chooses from. A factorization of the library's own is a
// source file with one Builtin, listed in make_factor.cpp.
#pragma once
#include "structure/solver/factor.hpp"
#include <string>

namespace plm {

struct Builtin {
    SolverName name;
    std::unique_ptr<Factor> (*factor)(const SparseMatrix &a, FactorKind kind);
    std::string (*version)(); // "CHOLMOD 3.0.14"
};

std::unique_ptr<Factor> make_host_factor(const SparseMatrix &a, FactorKind kind, const HostSolver &host);

} // namespace plm
