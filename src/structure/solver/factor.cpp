#include "structure/solver/factor.hpp"
#include "linalg/error.hpp"

namespace plm {

void throw_not_positive_definite(std::int64_t column) {
    throw Error(status::not_positive_definite,
                format("matrix is not positive definite: factorization stops at row %lld",
                       static_cast<long long>(column)))
        .reason(reason::not_positive_definite)
        .index(column);
}

void throw_singular(std::int64_t column) {
    throw Error(status::singular,
                format("matrix is singular: no usable pivot at row %lld", static_cast<long long>(column)))
        .reason(reason::singular)
        .index(column);
}

} // namespace plm
