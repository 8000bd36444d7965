// Lowest eigenpairs of a sparse symmetric pencil by Lanczos methods in shift-invert mode.
#pragma once
#include "factor.hpp"
#include <functional>

namespace plm {

struct EigenPairs {
    vector<double> values; // ascending
    Matrix vectors;        // M-orthonormal columns
};

/// library_code of the error (PLM_ERR_EIGENSOLVER) where some did not converge within the allowed restarts.
constexpr std::int64_t eigs_too_few = -1;

struct EigsOptions {
    double tolerance = 0; // relative accuracy of the Ritz values; 0 = machine precision
    std::int64_t max_restarts = 300;
    std::int64_t max_attempts = 3;   // each with twice the vectors, where the one before did not converge
    std::function<bool()> cancelled; // polled before each operation; true stops (PLM_CANCELLED)
};

/// The n_wanted eigenpairs of K x = lambda M x that lie closest above `shift`, where `factor` is of K - shift
/// M and no eigenvalue lies below `shift` (positive definite factor). K and M symmetric, M positive
/// semi-definite. Fewer are returned when the pencil has fewer finite eigenvalues. Multiple eigenvalues come
/// with all their copies. Small, nearly mass-less or fully wanted problems are solved densely. Deterministic
/// start vector. Problems run side by side, also one inside a callback of another.
EigenPairs lowest_eigenpairs(const SparseMatrix &k, const SparseMatrix &m, const Factor &factor, double shift,
                             std::int64_t n_wanted, const EigsOptions &options = {});

} // namespace plm
