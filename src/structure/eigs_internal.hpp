// Private to linalg: the two ways in which lowest_eigenpairs (eigs.cpp) solves a pencil.
#pragma once
#include "structure/eigen_pairs.hpp"
#include "structure/random_columns.hpp"
#include "structure/solver/factor.hpp"

namespace plm {

/// K x = lambda M x with the factor of A = K - shift M, and what all the steps need to know about it.
struct Pencil {
    const TallMatrix &k, &m;
    const TallFactor &factor;
    double shift;
    const EigsOptions &options;
    std::int64_t massive; // DOFs with a positive diagonal entry in M: the others carry no finite eigenvalue
    /// No columns, in the place of those that are looked for.
    Field place;
    std::int64_t size() const { return k.rows(); }
    /// Upper bound of the number of finite eigenvalues.
    std::int64_t rank() const { return massive; }
    void poll() const; // throws PLM_CANCELLED
};

/// All finite eigenpairs by a dense eigenproblem of order rank(); the lowest n_wanted are returned. Vectors
/// have unit M-norm.
EigenPairs dense_eigenpairs(const Pencil &pencil, std::int64_t n_wanted);

/// Makes the columns of X M-orthonormal, one after another, and returns M X.
Field orthonormalize(const TallMatrix &m, Field &x);
/// Pairs that miss K x = lambda M x by more than rounding, row by row, become better ones; mx: M X. Their
/// order may be another one then. Throws PLM_ERR_EIGENSOLVER where one does not come to meet it.
void improve(const Pencil &pencil, EigenPairs &pairs, Field mx);

struct KrylovRequest {
    std::int64_t n_wanted, n_lanczos; // pairs, and the largest dimension of the space: more than n_wanted
    double tolerance;                 // of theta, relative; 0: machine precision
    std::int64_t max_restarts;
    std::int64_t seed;      // of the start vectors
    std::int64_t width = 1; // of a block of the Lanczos method of our own
    /// Columns (M-orthonormal) and M times them that the search is kept away from; null for none.
    const Field *apart = nullptr, *m_apart = nullptr;
    KnownPairs known = {}; // where the search begins
    bool keep_rest = false;
    double of_interest = 0; // a pair counts as converged once its theta is certainly smaller
};
enum class KrylovEnd {
    converged,
    too_few,  // converged within the restarts
    exhausted // the space closed in itself with fewer dimensions than pairs wanted: M has too low a rank
};
struct KrylovResult {
    KrylovEnd end;
    EigenPairs pairs; // the converged ones; their rest, where it is asked for and all have converged
};
/// By a block Lanczos method of our own: nothing is shared, the host is asked whether to go on.
KrylovResult run_lanczos(const Pencil &pencil, const KrylovRequest &request);
/// By ARPACK, whose state is the process's: others wait meanwhile, and nothing of the host may be called. For
/// problems of an instant with a factorization of ours, without known columns.
KrylovResult run_arpack(const Pencil &pencil, const KrylovRequest &request);

} // namespace plm
