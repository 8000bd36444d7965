// Lowest eigenpairs of a sparse symmetric pencil by Lanczos methods in shift-invert mode.
#pragma once
#include "structure/eigen_pairs.hpp"
#include "structure/solver/factor.hpp"

namespace plm {

/// The n_wanted eigenpairs of K x = lambda M x that lie closest above `shift`, where `factor` is of K - shift
/// M and no eigenvalue lies below `shift` (positive definite factor). K and M symmetric, M positive
/// semi-definite. Fewer are returned when the pencil has fewer finite eigenvalues. Multiple eigenvalues come
/// with all their copies. Small, nearly mass-less or fully wanted problems are solved densely. Deterministic
/// start vector. Problems run side by side, also one inside a callback of another.
EigenPairs lowest_eigenpairs(const TallMatrix &k, const TallMatrix &m, const TallFactor &factor, double shift,
                             std::int64_t n_wanted, const EigsOptions &options = {});
/// The same in core.
EigenPairs lowest_eigenpairs(const SparseMatrix &k, const SparseMatrix &m, const Factor &factor, double shift,
                             std::int64_t n_wanted, const EigsOptions &options = {});

} // namespace plm
