// CHOLMOD with 64-bit indices behind the seam of factor.hpp.
#include "linalg/blas_lapack.hpp"
#include "structure/solver/cholmod_analysis.hpp"
#include "structure/solver/factor_builtin.hpp"
#include "structure/solver/ordering.hpp"
#include "structure/solver/refined_factor.hpp"
#include <algorithm>

namespace plm {
namespace {

/// Right-hand sides solved at once: enough for BLAS 3 speed, and bounds the workspace to 2 n x 64.
constexpr std::int64_t solve_block = 64;

class CholmodFactor final : public Factor {
  public:
    /// The numbers for an analysis; `a` has rows.
    CholmodFactor(const SparseMatrix &a, std::unique_ptr<Cholmod> analysis)
        : n_(a.cols), analysis_(std::move(analysis)), lib_(*analysis_) {
        cholmod_common &c = lib_.common;
        nonzeros_ = static_cast<std::int64_t>(c.lnz);
        c.final_ll = 1;
        c.quick_return_if_not_posdef = 1;
        cholmod_sparse matrix = view(a);
        cholmod_l_factorize(&matrix, lib_.factor, &c);
        lib_.check("factorize");
        lib_.note_memory();
        const auto reached = static_cast<std::int64_t>(lib_.factor->minor);
        if (reached < n_) throw_not_positive_definite(indices(lib_.factor->Perm)[reached]);
        const double rcond = cholmod_l_rcond(lib_.factor, &c);
        reciprocal_condition_ = rcond >= 0 ? rcond : 0; // NaN gives 0
    }

    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const override {
        require(ldx >= n_, "Factor::solve: leading dimension");
        for (std::int64_t first = 0; first < nrhs; first += solve_block)
            solve_some(x + first * ldx, std::min(solve_block, nrhs - first), ldx);
    }
    double reciprocal_condition() const override { return reciprocal_condition_; }
    std::int64_t factor_nonzeros() const override { return nonzeros_; }

  private:
    void solve_some(double *x, std::int64_t nrhs, std::int64_t ldx) const {
        cholmod_dense rhs = view(x, n_, nrhs, ldx);
        const cholmod_factor &f = *lib_.factor;
        if (f.is_super) { // cholmod_l_solve2 forgets that it got no Y once it got E, and writes to it
            lib_.shape(lib_.y, f.n, static_cast<std::size_t>(nrhs));
            lib_.shape(lib_.e, static_cast<std::size_t>(nrhs), f.maxesize);
        }
        const int ok = cholmod_l_solve2(CHOLMOD_A, lib_.factor, &rhs, nullptr, &lib_.x, nullptr, &lib_.y,
                                        &lib_.e, &lib_.common);
        lib_.check("solve");
        lib_.note_memory();
        require(ok && lib_.x, "cholmod_l_solve2 failed");
        const auto *result = static_cast<const double *>(lib_.x->x);
        for (std::int64_t j = 0; j < nrhs; ++j) std::copy_n(result + j * lib_.x->d, n_, x + j * ldx);
    }

    std::int64_t n_, nonzeros_ = 0;
    double reciprocal_condition_ = 1;
    std::unique_ptr<Cholmod> analysis_;
    Cholmod &lib_; // CHOLMOD's solve takes its factor and its workspace by non-const pointer
};

/// Of a matrix without rows.
class NoFactor final : public Factor {
  public:
    void solve(double *, std::int64_t, std::int64_t) const override {}
    double reciprocal_condition() const override { return 1; }
    std::int64_t factor_nonzeros() const override { return 0; }
};

std::unique_ptr<Factor> factor_by_cholmod(const SparseMatrix &a, const Solver &solver) {
    if (a.cols == 0) return std::make_unique<NoFactor>();
    auto lib = std::make_unique<Cholmod>();
    lib->analyze(a, solver);
    if (solver.precision == FactorPrecision::single)
        return std::make_unique<RefinedFactor>(a, lib->supernodes());
    return std::make_unique<CholmodFactor>(a, std::move(lib));
}

/// CHOLMOD finds the supernodes; its own L D L^T knows none, and takes ten times as long on solids and more.
std::int64_t count_negative_by_cholmod(const SparseMatrix &a, const Solver &solver) {
    if (a.cols == 0) return 0;
    Cholmod lib;
    lib.analyze(a, solver);
    lib.note_memory();
    return eliminate_fronts(a, lib.supernodes());
}

FactorEstimate estimate_for_cholmod(const SparseMatrix &a, const Solver &solver) {
    if (a.cols == 0) return {};
    Cholmod lib;
    lib.analyze(a, solver);
    return lib.estimate(a);
}

std::string cholmod_version() {
    int version[3];
    cholmod_l_version(version);
    return format("CHOLMOD %d.%d.%d", version[0], version[1], version[2]) + ordering_backend();
}

} // namespace

extern const Builtin solver_cholmod;
const Builtin solver_cholmod{SolverName::cholmod, factor_by_cholmod, count_negative_by_cholmod,
                             estimate_for_cholmod, cholmod_version};

} // namespace plm
