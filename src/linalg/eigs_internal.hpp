// Private to linalg: the two ways in which lowest_eigenpairs (eigs.cpp) solves a pencil.
#pragma once
#include "eigs.hpp"

namespace plm {

/// K x = lambda M x with the factor of A = K - shift M, and what all the steps need to know about it.
struct Pencil {
    const SparseMatrix &k, &m;
    const Factor &factor;
    double shift;
    const EigsOptions &options;
    vector<std::int64_t>
        massive; // DOFs with a positive diagonal entry in M: the others carry no finite eigenvalue
    std::int64_t size() const { return k.cols; }
    /// Upper bound of the number of finite eigenvalues.
    std::int64_t rank() const { return static_cast<std::int64_t>(massive.size()); }
    void poll() const; // throws PLM_CANCELLED
};

/// All finite eigenpairs by a dense eigenproblem of order rank(); the lowest n_wanted are returned. Vectors
/// have unit M-norm.
EigenPairs dense_eigenpairs(const Pencil &pencil, std::int64_t n_wanted);

struct ArpackRequest {
    std::int64_t n_wanted, n_lanczos; // nev, ncv
    double tolerance;
    std::int64_t max_restarts;
    int seed; // of the start vector
    /// Columns (M-orthonormal) and M times them that the search is kept away from; null for none.
    const Matrix *known = nullptr, *m_known = nullptr;
};
struct ArpackResult {
    int info = 0;     // of dsaupd or dseupd; 1: too few converged within the restarts
    EigenPairs pairs; // the converged ones, in ARPACK's order
};
/// One complete dsaupd/dseupd problem under the process-wide lock. Throws PLM_ERR_STATE when called from
/// inside another one on this thread.
ArpackResult run_arpack(const Pencil &pencil, const ArpackRequest &request);
const char *arpack_meaning(int info);

} // namespace plm
