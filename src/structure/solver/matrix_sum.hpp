// Private to structure: a sum of two matrices that need not be formed.
#pragma once
#include "structure/sparse.hpp"

namespace plm {

/// A + factor B; B null: A alone. It refers to both.
struct MatrixSum {
    MatrixSum(const SparseMatrix &first) : a(first) {}
    MatrixSum(const SparseMatrix &first, double times, const SparseMatrix &second)
        : a(first), factor(times), b(&second) {}
    SparseMatrix formed() const { return b ? add(1.0, a, factor, *b) : a; }

    const SparseMatrix &a;
    double factor = 0;
    const SparseMatrix *b = nullptr;
};

/// Whether B has entries only where A has: then what is known of A's pattern holds for the sum.
bool keeps_pattern(const MatrixSum &sum);

} // namespace plm
