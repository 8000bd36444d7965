#include "structure/solver/make_factor.hpp"
#include "linalg/blas_lapack.hpp"
#include "structure/solver/factor_builtin.hpp"
#include <cmath>

namespace plm {

std::unique_ptr<Factor> make_factor(const SparseMatrix &a, FactorKind kind, const HostSolver *host) {
    require(a.rows == a.cols && static_cast<std::int64_t>(a.ptr.size()) == a.cols + 1, "make_factor: shape");
    // NaN passes through a Cholesky factorization unnoticed (no comparison with it is true).
    if (!finite(a.val.data(), a.nnz())) {
        std::int64_t j = 0, p = 0;
        while (std::isfinite(a.val[p])) ++p;
        while (a.ptr[j + 1] <= p) ++j;
        throw Error(PLM_ERR_MATRIX, "NaN or Inf in the matrix to factor").index(j);
    }
    return host ? make_host_factor(a, kind, *host) : make_builtin_factor(a, kind);
}

} // namespace plm
