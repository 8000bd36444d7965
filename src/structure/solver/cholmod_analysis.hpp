// Private to structure/solver: CHOLMOD's objects with 64-bit indices, and its symbolic analysis, which serves
// its own numbers and those of fronts.hpp alike.
#pragma once
#include "linalg/memory_count.hpp"
#include "structure/solver/factor.hpp"
#include "structure/solver/fronts.hpp"
#include <cholmod.h>

namespace plm {

/// CHOLMOD's view of our arrays; it reads one triangle of them and never writes.
cholmod_sparse view(const SparseMatrix &a);
cholmod_dense view(double *x, std::int64_t rows, std::int64_t cols, std::int64_t ld);

/// Its arrays of 64-bit indices.
inline const std::int64_t *indices(const void *array) {
    return static_cast<const std::int64_t *>(array);
}

/// From so many flops on the library's own factorization serves, by CHOLMOD's supernodes: as fast as
/// CHOLMOD's, and faster on more than one thread.
constexpr double shared_out_from = 1e9;

/// Everything CHOLMOD allocates for one factor, with a cholmod_common of its own: no state is shared.
struct Cholmod {
    cholmod_common common;
    cholmod_factor *factor = nullptr;
    cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr; // kept by cholmod_l_solve2 between calls
    ForeignMemory memory;

    Cholmod();
    ~Cholmod();
    Cholmod(const Cholmod &) = delete;
    Cholmod &operator=(const Cholmod &) = delete;

    /// Ordering and supernodes, without numbers: by the host's order where it gave one for as many rows, else
    /// by the one of nested dissection and approximate minimum degree that leaves fewer entries in L.
    void analyze(const SparseMatrix &a, const Solver &solver);
    /// Valid until the numbers come, or the object goes.
    Supernodes supernodes() const;
    FactorEstimate estimate(const SparseMatrix &a) const;

    void note_memory() { memory.holds(common.memory_inuse, common.memory_usage); }
    /// As cholmod_l_ensure_dense, but a failure is seen.
    void shape(cholmod_dense *&block, std::size_t rows, std::size_t cols);
    void check(const char *step) const;

  private:
    void order(const SparseMatrix &a, const vector<std::int64_t> &given, bool try_minimum_degree);
};

} // namespace plm
