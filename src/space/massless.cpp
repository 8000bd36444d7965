#include "space/massless.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace plm {
namespace {

void append_scaled(const Matrix &y, std::int64_t column, double factor, Matrix &to, std::int64_t at) {
    for (std::int64_t i = 0; i < y.rows(); ++i) to(i, at) = factor * y(i, column);
}

} // namespace

RitzVectors ritz_vectors(const vector<double> &mu, const Matrix &y, double sigma, double reach) {
    const std::int64_t n = static_cast<std::int64_t>(mu.size());
    const double rounding = n > 0 ? 1e-15 * mu.back() : 0;
    const double slow = std::max(negligible_inertia / (reach * reach + sigma), rounding);
    std::int64_t n_massless = 0;
    while (reach > 0 && n_massless < n && mu[n_massless] < slow) ++n_massless;
    RitzVectors r{{}, Matrix(y.rows(), n), n_massless};
    for (std::int64_t j = n - 1; j >= n_massless; --j) { // energy 1 -> mass 1
        const double compliance = std::max(mu[j], rounding), value = 1 / compliance - sigma;
        append_scaled(y, j, 1 / std::sqrt(compliance), r.vectors, n - 1 - j);
        r.lambda.push_back(std::abs(value) < 1e-10 * sigma ? 0.0 : std::max(value, 0.0));
    }
    for (std::int64_t j = 0; j < n_massless; ++j) {
        append_scaled(y, j, reach, r.vectors, n - n_massless + j);
        r.lambda.push_back(reach * reach);
    }
    return r;
}

Matrix coordinates_of(const Structure &structure, const Field &motions,
                      const std::function<Matrix(const Field &)> &works, const vector<double> &lambda,
                      std::int64_t n_massless) {
    Matrix c = works(structure.mass_times(motions));
    if (n_massless == 0) return c;
    const Matrix elastic = works(structure.stiffness_times(motions));
    for (std::int64_t k = 0; k < c.cols(); ++k)
        for (std::int64_t j = c.rows() - n_massless; j < c.rows(); ++j) c(j, k) = elastic(j, k) / lambda[j];
    return c;
}

Matrix orthonormal_span(const Matrix &columns, std::int64_t n_massless) {
    return n_massless == 0 || columns.cols() == 0 ? columns : thin_svd(columns).u;
}

} // namespace plm
