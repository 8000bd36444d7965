// Products with matrices that fit into the processor's caches, by rows in the lanes of its vectors: what a
// call of BLAS costs beside its flops counts here, and each entry is read once for all that is asked of it.
#pragma once
#include "linalg/dense.hpp"
#include "linalg/lanes.hpp"

namespace plm {

/// y = alpha A x + beta c. y must not overlap x or c.
void multiply_and_add(const Matrix &a, double alpha, const double *x, double beta, const double *c, double *y,
                      bool wide = has_wide_lanes());

/// The products of A with three vectors, one after the other in x and in ax, and with `sizes` that of the
/// sizes of its entries: bound = |A| sizes.
void multiply_three_and_bound(const Matrix &a, const double *x, const double *sizes, double *ax,
                              double *bound, bool wide = has_wide_lanes());

} // namespace plm
