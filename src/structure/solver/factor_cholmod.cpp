// CHOLMOD with 64-bit indices behind the seam of factor.hpp.
#include "linalg/blas_lapack.hpp"
#include "linalg/parallel.hpp"
#include "structure/solver/cholmod_analysis.hpp"
#include "structure/solver/factor_builtin.hpp"
#include "structure/solver/ordering.hpp"
#include "structure/solver/refined_factor.hpp"
#include "structure/solver/response_products.hpp"
#include <algorithm>
#include <mutex>

namespace plm {
namespace {

/// Right-hand sides solved at once: enough for BLAS 3 speed, and bounds the workspace to 2 n x 32.
constexpr std::int64_t solve_block = 32;

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
        (BlasTurn(), cholmod_l_factorize(&matrix, lib_.factor, &c));
        lib_.check("factorize");
        lib_.note_memory();
        const auto reached = static_cast<std::int64_t>(lib_.factor->minor);
        if (reached < n_) throw_not_positive_definite(indices(lib_.factor->Perm)[reached]);
        const double rcond = cholmod_l_rcond(lib_.factor, &c);
        reciprocal_condition_ = rcond >= 0 ? rcond : 0; // NaN gives 0
    }

    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const override {
        require(ldx >= n_, "Factor::solve: leading dimension");
        parallel_for((nrhs + solve_block - 1) / solve_block, [&](std::int64_t k) {
            const std::int64_t first = k * solve_block;
            std::unique_ptr<Cholmod> workspace = take_workspace();
            solve_some(x + first * ldx, std::min(solve_block, nrhs - first), ldx, *workspace);
            give_back(std::move(workspace));
        });
    }
    double reciprocal_condition() const override { return reciprocal_condition_; }
    std::int64_t factor_nonzeros() const override { return nonzeros_; }

  private:
    // One for each thread that solves at once; the factor is only read.
    std::unique_ptr<Cholmod> take_workspace() const {
        {
            const std::lock_guard<std::mutex> lock(idle_mutex_);
            if (!idle_.empty()) {
                std::unique_ptr<Cholmod> one = std::move(idle_.back());
                idle_.pop_back();
                return one;
            }
        }
        return std::make_unique<Cholmod>();
    }
    void give_back(std::unique_ptr<Cholmod> one) const {
        const std::lock_guard<std::mutex> lock(idle_mutex_);
        idle_.push_back(std::move(one));
    }

    void solve_some(double *x, std::int64_t nrhs, std::int64_t ldx, Cholmod &w) const {
        cholmod_dense rhs = view(x, n_, nrhs, ldx);
        const cholmod_factor &f = *lib_.factor;
        if (f.is_super) { // cholmod_l_solve2 forgets that it got no Y once it got E, and writes to it
            w.shape(w.y, f.n, static_cast<std::size_t>(nrhs));
            w.shape(w.e, static_cast<std::size_t>(nrhs), f.maxesize);
        }
        const int ok = (BlasTurn(), cholmod_l_solve2(CHOLMOD_A, lib_.factor, &rhs, nullptr, &w.x, nullptr,
                                                     &w.y, &w.e, &w.common));
        w.check("solve");
        w.note_memory();
        require(ok && w.x, "cholmod_l_solve2 failed");
        const auto *result = static_cast<const double *>(w.x->x);
        for (std::int64_t j = 0; j < nrhs; ++j) std::copy_n(result + j * w.x->d, n_, x + j * ldx);
    }

    std::int64_t n_, nonzeros_ = 0;
    double reciprocal_condition_ = 1;
    std::unique_ptr<Cholmod> analysis_;
    Cholmod &lib_; // CHOLMOD's solve takes its factor by non-const pointer
    mutable std::mutex idle_mutex_;
    mutable std::vector<std::unique_ptr<Cholmod>> idle_; // workspaces
};

class SharedFactor final : public Factor {
  public:
    SharedFactor(const SparseMatrix &a, const Cholmod &analysis)
        : n_(a.cols), nonzeros_(static_cast<std::int64_t>(analysis.common.lnz)),
          factor_(a, analysis.supernodes()) {}
    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const override {
        require(ldx >= n_, "Factor::solve: leading dimension");
        constexpr std::int64_t block = PanelFactor<double>::widest_solve;
        for (std::int64_t first = 0; first < nrhs; first += block)
            factor_.solve(x + first * ldx, std::min(block, nrhs - first), ldx);
    }
    bool multiply_responses(const SparseMatrix &f, const SparseMatrix &m, Matrix &energy,
                            Matrix &inertia) const override {
        return plm::multiply_responses(factor_, f, m, energy, inertia);
    }
    double reciprocal_condition() const override { return factor_.reciprocal_condition(); }
    std::int64_t factor_nonzeros() const override { return nonzeros_; }

  private:
    std::int64_t n_, nonzeros_;
    PanelFactor<double> factor_;
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
    if (lib->common.fl >= shared_out_from) return std::make_unique<SharedFactor>(a, *lib);
    return std::make_unique<CholmodFactor>(a, std::move(lib));
}

/// CHOLMOD finds the supernodes; its own L D L^T knows none, and takes ten times as long on solids and more.
std::int64_t count_negative_by_cholmod(const MatrixSum &a, const Solver &solver) {
    if (a.a.cols == 0) return 0;
    if (!keeps_pattern(a)) return count_negative_by_cholmod(a.formed(), solver);
    Cholmod lib;
    lib.analyze(a.a, solver);
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
