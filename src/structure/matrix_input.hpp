// A sparse symmetric matrix in the caller's own format: checked at the entry, turned into a SparseMatrix at
// the build.
#pragma once
#include "linalg/error.hpp"
#include "structure/sparse.hpp"
#include <memory>
#include <variant>

namespace plm {

class TallOperations; // tall_operations.hpp

/// How the caller's arrays are to be read: PLM_CSC ... and PLM_FULL ... of plm.h.
namespace storage {
enum : std::int32_t { csc = 1, triplets = 2, csr = 3 };
}
namespace part {
enum : std::int32_t { full = 1, lower = 2, upper = 3 };
}

/// Theirs, and the first index (0 or 1).
struct MatrixFormat {
    std::int64_t n = 0, nnz = 0;
    std::int32_t storage = storage::csc, part = part::full, index_base = 0;
    bool copy = true;               // false: the arrays stay the caller's and must outlive the build
    bool negative_diagonal = false; // allowed? Not for M and K, which are positive semi-definite
};

template <class Index> struct IndexArrays {
    const Index *a = nullptr, *b = nullptr; // what to read: the caller's or those below
    vector<Index> own_a, own_b;
};

struct MatrixInput {
    /// CSC, CSR: a[n + 1] pointers, b[nnz] numbers; triplets: a[nnz] rows, b[nnz] columns.
    template <class Index>
    MatrixInput(const MatrixFormat &format, const Index *a, const Index *b, const double *value);

    explicit MatrixInput(std::shared_ptr<TallOperations> operations) : behind(std::move(operations)) {}

    /// Throws PLM_ERR_MATRIX with argument "a", "b" or "value" and the position in that array as index.
    void check() const;
    /// Full symmetric n x n; the upper triangle is the mirror of the lower (of the stored one, if one is
    /// stored), so the result is symmetric to the last bit. Borrowed arrays are checked again: they may have
    /// changed meanwhile.
    SparseMatrix to_sparse() const;

    const MatrixFormat layout;
    /// Null; or it is one of those that the host keeps behind these operations, and there is nothing to read.
    const std::shared_ptr<TallOperations> behind;

  private:
    std::variant<IndexArrays<std::int32_t>, IndexArrays<std::int64_t>> index_;
    const double *value_ = nullptr;
    vector<double> own_value_;
};

} // namespace plm
