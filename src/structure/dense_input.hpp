// A dense symmetric matrix of the caller's, such as that of a superelement: checked at the entry, turned into
// a MatrixInput.
#pragma once
#include "structure/matrix_input.hpp"

namespace plm {

struct DenseFormat {
    std::int64_t n = 0, ld = 0;     // column-major, entry (i, j) at i + j ld
    std::int32_t part = part::full; // what is read
    bool semi_definite = true;      // M and K must be; C need not
};

/// Throws PLM_ERR_MATRIX or PLM_ERR_NOT_POSITIVE_DEFINITE. A matrix of which more than half is zero is
/// stored without its zeros, any other with all its entries, by which it is known to be dense from there on.
std::shared_ptr<const MatrixInput> make_dense_input(const DenseFormat &format, const double *value);

} // namespace plm
