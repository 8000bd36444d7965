// CHOLMOD with 64-bit indices behind the seam of factor.hpp.
#include "linalg/blas_lapack.hpp"
#include "linalg/memory_count.hpp"
#include "linalg/parallel.hpp"
#include "structure/solver/factor_builtin.hpp"
#include "structure/solver/multifrontal_inertia.hpp"
#include <algorithm>
#include <cholmod.h>
#include <mutex>
#include <new>

namespace plm {
namespace {

static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t), "cholmod_l_ must use 64-bit indices");

/// Right-hand sides solved at once: enough for BLAS 3 speed, and bounds the workspace to 2 n x 32.
constexpr std::int64_t solve_block = 32;

/// CHOLMOD's view of our arrays; it reads one triangle of them and never writes.
cholmod_sparse view(const SparseMatrix &a) {
    cholmod_sparse v = {};
    v.nrow = static_cast<std::size_t>(a.rows);
    v.ncol = static_cast<std::size_t>(a.cols);
    v.nzmax = static_cast<std::size_t>(a.nnz());
    v.p = const_cast<std::int64_t *>(a.ptr.data());
    v.i = const_cast<std::int64_t *>(a.idx.data());
    v.x = const_cast<double *>(a.val.data());
    v.stype = -1;
    v.itype = CHOLMOD_LONG;
    v.xtype = CHOLMOD_REAL;
    v.dtype = CHOLMOD_DOUBLE;
    v.sorted = 1;
    v.packed = 1;
    return v;
}

cholmod_dense view(double *x, std::int64_t rows, std::int64_t cols, std::int64_t ld) {
    cholmod_dense v = {};
    v.nrow = static_cast<std::size_t>(rows);
    v.ncol = static_cast<std::size_t>(cols);
    v.nzmax = static_cast<std::size_t>(ld * cols);
    v.d = static_cast<std::size_t>(ld);
    v.x = x;
    v.xtype = CHOLMOD_REAL;
    v.dtype = CHOLMOD_DOUBLE;
    return v;
}

/// Everything CHOLMOD allocates for one factor, or for the solutions of one thread with it, with a
/// cholmod_common of its own: no state is shared.
struct Cholmod {
    cholmod_common common;
    cholmod_factor *factor = nullptr;
    cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr; // kept by cholmod_l_solve2 between calls
    ForeignMemory memory;

    Cholmod() {
        cholmod_l_start(&common);
        common.print = 0; // it would print its warnings to stdout
        common.error_handler = nullptr;
    }
    ~Cholmod() {
        cholmod_l_free_dense(&x, &common);
        cholmod_l_free_dense(&y, &common);
        cholmod_l_free_dense(&e, &common);
        cholmod_l_free_factor(&factor, &common);
        cholmod_l_finish(&common);
    }
    Cholmod(const Cholmod &) = delete;
    Cholmod &operator=(const Cholmod &) = delete;

    /// Ordering and supernodes, without numbers.
    void analyze(const SparseMatrix &a) {
        set_ordering();
        common.supernodal = CHOLMOD_SUPERNODAL;
        cholmod_sparse matrix = view(a);
        factor = cholmod_l_analyze(&matrix, &common);
        check("analyze");
    }

    void note_memory() { memory.holds(common.memory_inuse, common.memory_usage); }

    /// As cholmod_l_ensure_dense, but a failure is seen.
    void shape(cholmod_dense *&block, std::size_t rows, std::size_t cols) {
        if (block && block->nrow == rows && block->ncol == cols && block->d == rows) return;
        cholmod_l_free_dense(&block, &common);
        block = cholmod_l_allocate_dense(rows, cols, rows, CHOLMOD_REAL, &common);
        check("workspace");
    }

    void check(const char *step) const {
        if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
        if (common.status < 0)
            throw Error(PLM_ERR_INTERNAL, format("CHOLMOD, %s: status %d", step, common.status))
                .library_code(common.status);
    }

  private:
    /// AMD only. METIS orders three-dimensional bodies better, but METIS_NodeND of METIS 5.1 re-seeds the
    /// host's rand(), installs handlers for SIGTERM and SIGABRT while it runs and long-jumps from them, and
    /// what it returns depends on who else calls rand(). No host has to put up with that from a library.
    void set_ordering() {
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_AMD;
        common.postorder = 1;
    }
};

const std::int64_t *indices(const void *array) {
    return static_cast<const std::int64_t *>(array);
}

class CholmodFactor final : public Factor {
  public:
    explicit CholmodFactor(const SparseMatrix &a) : n_(a.cols) {
        if (n_ == 0) return;
        lib_.analyze(a);
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
        if (n_ == 0) return;
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
        const int ok =
            cholmod_l_solve2(CHOLMOD_A, lib_.factor, &rhs, nullptr, &w.x, nullptr, &w.y, &w.e, &w.common);
        w.check("solve");
        w.note_memory();
        require(ok && w.x, "cholmod_l_solve2 failed");
        const auto *result = static_cast<const double *>(w.x->x);
        for (std::int64_t j = 0; j < nrhs; ++j) std::copy_n(result + j * w.x->d, n_, x + j * ldx);
    }

    std::int64_t n_, nonzeros_ = 0;
    double reciprocal_condition_ = 1;
    Cholmod lib_;
    mutable std::mutex idle_mutex_;
    mutable std::vector<std::unique_ptr<Cholmod>> idle_; // workspaces
};

std::unique_ptr<Factor> factor_by_cholmod(const SparseMatrix &a) {
    return std::make_unique<CholmodFactor>(a);
}

/// CHOLMOD finds the supernodes; its own L D L^T knows none, and takes ten times as long on solids and more.
std::int64_t count_negative_by_cholmod(const SparseMatrix &a) {
    if (a.cols == 0) return 0;
    Cholmod lib;
    lib.analyze(a);
    lib.note_memory();
    const cholmod_factor &f = *lib.factor;
    return count_negative_pivots(a, {static_cast<std::int64_t>(f.nsuper), indices(f.super), indices(f.pi),
                                     indices(f.s), indices(f.Perm)});
}

std::string cholmod_version() {
    int version[3];
    cholmod_l_version(version);
    return format("CHOLMOD %d.%d.%d", version[0], version[1], version[2]);
}

} // namespace

extern const Builtin solver_cholmod;
const Builtin solver_cholmod{SolverName::cholmod, factor_by_cholmod, count_negative_by_cholmod,
                             cholmod_version};

} // namespace plm
