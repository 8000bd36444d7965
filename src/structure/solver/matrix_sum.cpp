#include "structure/solver/matrix_sum.hpp"
#include <algorithm>

namespace plm {

bool keeps_pattern(const MatrixSum &sum) {
    if (!sum.b) return true;
    const SparseMatrix &a = sum.a, &b = *sum.b;
    for (std::int64_t j = 0; j < b.cols; ++j) // rows ascend
        if (!std::includes(a.idx.begin() + a.ptr[j], a.idx.begin() + a.ptr[j + 1], b.idx.begin() + b.ptr[j],
                           b.idx.begin() + b.ptr[j + 1]))
            return false;
    return true;
}

} // namespace plm
