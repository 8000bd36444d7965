// Private to structure/solver: what make_factor() chooses from. A factorization of the library's own is a
// source file with one Builtin, listed in make_factor.cpp.
#pragma once
#include "structure/solver/factor.hpp"
#include "structure/solver/matrix_sum.hpp"
#include <string>

namespace plm {

struct Builtin {
    SolverName name;
    std::unique_ptr<Factor> (*factor)(const SparseMatrix &a, const Solver &solver);
    std::int64_t (*count_negative)(const MatrixSum &a, const Solver &solver);
    FactorEstimate (*estimate)(const SparseMatrix &a, const Solver &solver);
    std::string (*version)(); // "CHOLMOD 3.0.14"
};

/// Of a matrix that is_dense().
std::unique_ptr<Factor> make_dense_factor(const SparseMatrix &a);
std::unique_ptr<Factor> make_host_factor(const SparseMatrix &a, const HostSolver &host);
std::int64_t count_negative_by_host(const SparseMatrix &a, const HostSolver &host);

} // namespace plm
