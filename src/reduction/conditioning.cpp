#include "reduction/conditioning.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {

Coordinates diagonalise_stiffness(const Space &space, const Matrix &orthonormal) {
    Matrix scaled = orthonormal; // diag(sqrt(lambda)) U: its Gram matrix is k, symmetric to the last bit
    for (std::int64_t j = 0; j < scaled.cols(); ++j)
        for (std::int64_t i = 0; i < scaled.rows(); ++i) scaled(i, j) *= std::sqrt(space.lambda[i]);
    SymmetricEigen eigen = symmetric_eigen(product('T', 'N', scaled, scaled));
    Coordinates c;
    c.y = product('N', 'N', orthonormal, eigen.vectors);
    c.lambda = std::move(eigen.values);
    const double rounding = c.lambda.empty() ? 0 : 1e-14 * c.lambda.back();
    for (double &l : c.lambda)
        if (l < rounding) l = 0; // rigid-body motion
    return c;
}

Conditioned condition_columns(const Space &space, const Matrix &columns, double tolerance) {
    Svd svd = thin_svd(columns); // coordinates are M-orthonormal: this is the SVD in the M-inner product
    Conditioned result;
    const double largest = svd.values.empty() ? 0 : svd.values.front();
    if (!(largest > 0))
        throw Error(PLM_ERR_INTERNAL, "the collected modes have no direction")
            .reason(PLM_REASON_BASIS_TOO_SMALL);
    std::int64_t kept = 0;
    for (double s : svd.values) {
        result.singular_values.push_back(s / largest);
        if (s > tolerance * largest) ++kept;
    }
    result.coordinates = diagonalise_stiffness(space, svd.u.columns(0, kept));
    return result;
}

} // namespace plm
