#include "blas_host.hpp"
#include "blas_lapack.hpp"

namespace plm {

bool blas_takes_other_integers() {
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    // Such a BLAS reads the count as a negative number and answers 0; nothing out of bounds is read either
    // way.
    const blas_int count[2] = {2, -1}, stride[2] = {1, 0};
    const double one[2] = {1, 1};
    return ddot_(count, one, stride, one, stride) != 2;
#else
    return false;
#endif
}

} // namespace plm
