#include "structure/solver/make_factor.hpp"
#include "linalg/blas_lapack.hpp"
#include "structure/solver/factor_builtin.hpp"
#include <cmath>

namespace plm {

#ifdef PLM_WITH_CHOLMOD
extern const Builtin solver_cholmod;
#endif
#ifdef PLM_WITH_EIGEN
extern const Builtin solver_eigen;
#endif

namespace {

// The first one serves where nothing is asked for.
const Builtin *const builtins[] = {
#ifdef PLM_WITH_CHOLMOD
    &solver_cholmod,
#endif
#ifdef PLM_WITH_EIGEN
    &solver_eigen,
#endif
};

const Builtin &builtin(SolverName name) {
    if (name == SolverName::automatic) return *builtins[0];
    for (const Builtin *one : builtins)
        if (one->name == name) return *one;
    const bool cholmod = name == SolverName::cholmod;
    throw Error(status::not_built, format("the solver %s was left out of this build; configure libplm with "
                                          "PLM_WITH_%s=ON, or leave \"solver\" at auto",
                                          cholmod ? "cholmod" : "eigen", cholmod ? "CHOLMOD" : "EIGEN"))
        .argument("solver");
}

void require_matrix(const SparseMatrix &a) {
    require(a.rows == a.cols && static_cast<std::int64_t>(a.ptr.size()) == a.cols + 1, "make_factor: shape");
    // NaN passes through a Cholesky factorization unnoticed (no comparison with it is true).
    if (finite(a.val.data(), a.nnz())) return;
    std::int64_t j = 0, p = 0;
    while (std::isfinite(a.val[p])) ++p;
    while (a.ptr[j + 1] <= p) ++j;
    throw Error(status::matrix, "NaN or Inf in the matrix to factor").index(j);
}

} // namespace

const HostSolver *Solver::serving_host() const {
    if (name == SolverName::host && !host)
        throw Error(status::state,
                    "\"solver\" is host, but the context has no solver of the host's: hand one "
                    "over before, or leave \"solver\" at auto")
            .argument("solver");
    return host && (name == SolverName::automatic || name == SolverName::host) ? &*host : nullptr;
}

std::unique_ptr<Factor> make_factor(const SparseMatrix &a, const Solver &solver) {
    require_matrix(a);
    const HostSolver *host = solver.serving_host();
    if (solver.precision == FactorPrecision::single &&
        (host || builtin(solver.name).name != SolverName::cholmod))
        throw Error(status::argument,
                    "\"factor_precision\" is single, which the solver cholmod alone offers; leave it at "
                    "auto or double, or choose that solver")
            .argument("factor_precision");
    if (host) return make_host_factor(a, *host);
    if (solver.name == SolverName::automatic && is_dense(a)) return make_dense_factor(a);
    return builtin(solver.name).factor(a, solver);
}

std::int64_t count_negative(const MatrixSum &a, const Solver &solver) {
    require_matrix(a.a);
    if (a.b) require_matrix(*a.b);
    if (const HostSolver *host = solver.serving_host()) return count_negative_by_host(a.formed(), *host);
    return builtin(solver.name).count_negative(a, solver);
}

std::optional<FactorEstimate> estimate_factor(const SparseMatrix &a, const Solver &solver) {
    if (solver.serving_host()) return {};
    return builtin(solver.name).estimate(a, solver);
}

std::string factor_backends() {
    std::string names;
    for (const Builtin *one : builtins) names += (names.empty() ? "" : ", ") + one->version();
    return names;
}

} // namespace plm
