// Private to structure/solver: what responses to forces do to one another, without the responses.
#pragma once
#include "structure/solver/panel_factor.hpp"

namespace plm {

/// For X = A^-1 F with sparse forces F, n x s: energy becomes F^T X, inertia X^T M X. The rows of X are
/// solved for subtree by subtree, used and forgotten; what is kept are those of the separators above. False,
/// and nothing is done, where M couples rows that A does not.
bool multiply_responses(const PanelFactor<double> &factor, const SparseMatrix &f, const SparseMatrix &m,
                        Matrix &energy, Matrix &inertia);

} // namespace plm
