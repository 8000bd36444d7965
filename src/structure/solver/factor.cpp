#include "structure/solver/factor.hpp"
#include "linalg/error.hpp"

namespace plm {

void throw_not_positive_definite(std::int64_t column) {
    throw Error(PLM_ERR_NOT_POSITIVE_DEFINITE,
                format("matrix is not positive definite: factorization stops at row %lld",
                       static_cast<long long>(column)))
        .reason(PLM_REASON_NOT_POSITIVE_DEFINITE)
        .index(column);
}

void throw_singular(std::int64_t column) {
    throw Error(PLM_ERR_SINGULAR,
                format("matrix is singular: no usable pivot at row %lld", static_cast<long long>(column)))
        .reason(PLM_REASON_SINGULAR)
        .index(column);
}

} // namespace plm
