#include "structure/solver/cholmod_analysis.hpp"
#include "linalg/error.hpp"
#include "structure/solver/ordering.hpp"
#include <new>

namespace plm {
namespace {

static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t), "cholmod_l_ must use 64-bit indices");

/// Below it nested dissection costs more time than it saves (measured on bricks and on plates).
constexpr std::int64_t small = 4000;

} // namespace

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

Cholmod::Cholmod() {
    cholmod_l_start(&common);
    common.print = 0; // it would print its warnings to stdout
    common.error_handler = nullptr;
}

Cholmod::~Cholmod() {
    cholmod_l_free_dense(&x, &common);
    cholmod_l_free_dense(&y, &common);
    cholmod_l_free_dense(&e, &common);
    cholmod_l_free_factor(&factor, &common);
    cholmod_l_finish(&common);
}

/// METIS is never asked: METIS_NodeND of METIS 5.1 re-seeds the host's rand(), installs handlers for SIGTERM
/// and SIGABRT while it runs and long-jumps from them, and what it returns depends on who else calls rand().
/// No host has to put up with that from a library.
void Cholmod::order(const SparseMatrix &a, const vector<std::int64_t> &given, bool try_minimum_degree) {
    common.nmethods = 0;
    if (!given.empty()) common.method[common.nmethods++].ordering = CHOLMOD_GIVEN;
    if (given.empty() || try_minimum_degree) common.method[common.nmethods++].ordering = CHOLMOD_AMD;
    common.postorder = 1;
    common.supernodal = CHOLMOD_SUPERNODAL;
    cholmod_sparse matrix = view(a);
    auto *order = const_cast<std::int64_t *>(given.data());
    factor = cholmod_l_analyze_p(&matrix, given.empty() ? nullptr : order, nullptr, 0, &common);
    check("analyze");
}

void Cholmod::analyze(const SparseMatrix &a, const Solver &solver) {
    if (static_cast<std::int64_t>(solver.order.size()) == a.cols) return order(a, solver.order, false);
    if (a.cols < small) return order(a, {}, true);
    const vector<std::int64_t> known = solver.orders ? solver.orders->find(a) : vector<std::int64_t>();
    if (!known.empty()) return order(a, known, false);
    order(a, nested_dissection(a), true);
    if (solver.orders) solver.orders->keep(a, indices(factor->Perm));
}

Supernodes Cholmod::supernodes() const {
    return {static_cast<std::int64_t>(factor->nsuper), indices(factor->super), indices(factor->pi),
            indices(factor->s), indices(factor->Perm)};
}

FactorEstimate Cholmod::estimate(const SparseMatrix &a) const {
    const double n = static_cast<double>(a.cols), entries = static_cast<double>(a.nnz());
    const FrontSizes sizes = front_sizes(a.cols, supernodes());
    const double integers = 8 * (static_cast<double>(factor->ssize) + 3.0 * factor->nsuper + 6 * n);
    FactorEstimate e;
    e.nonzeros = common.lnz;
    e.flops = common.fl;
    e.at_work = 8.0 * static_cast<double>(sizes.at_work) + integers;
    if (common.fl >= shared_out_from) {
        e.kept_full = 8.0 * static_cast<double>(sizes.panels) + integers;
        e.peak_full = e.kept_full + e.at_work;
    } else { // CHOLMOD permutes the matrix into a copy of half of it, twice, and updates by one block at a
             // time
        e.kept_full = 8.0 * static_cast<double>(factor->xsize) + integers;
        e.peak_full = e.kept_full + 16 * entries + 8.0 * static_cast<double>(factor->maxcsize);
    }
    // single panels come with half of the matrix, for the refinement
    e.kept_single = 4.0 * static_cast<double>(sizes.panels) + integers + 6 * (entries + n);
    e.peak_single = e.kept_single + 8.0 * static_cast<double>(sizes.at_work);
    return e;
}

void Cholmod::shape(cholmod_dense *&block, std::size_t rows, std::size_t cols) {
    if (block && block->nrow == rows && block->ncol == cols && block->d == rows) return;
    cholmod_l_free_dense(&block, &common);
    block = cholmod_l_allocate_dense(rows, cols, rows, CHOLMOD_REAL, &common);
    check("workspace");
}

void Cholmod::check(const char *step) const {
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common.status < 0)
        throw Error(status::internal, format("CHOLMOD, %s: status %d", step, common.status))
            .library_code(common.status);
}

} // namespace plm
