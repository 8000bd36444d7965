#include "reduction/conditioning.hpp"
#include "linalg/lapack.hpp"
#include "space/massless.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {

namespace {

// What makes K invertible where there is rigid-body motion.
double rigid_shift(const Space &space) {
    if (space.size() == 0 || space.lambda.front() > 0) return 0;
    for (double l : space.lambda)
        if (l > 0) return l;
    return 1;
}

// Basis of the columns that is orthonormal in K + sigma M, times the root of that matrix. Columns of one size
// first: their energies differ by many orders.
Matrix energy_orthonormal(Matrix columns, const vector<double> &root) {
    for (std::int64_t j = 0; j < columns.cols(); ++j) {
        double *c = columns.col(j);
        for (std::int64_t i = 0; i < columns.rows(); ++i) c[i] *= root[i];
        const double size = norm2(columns.rows(), c);
        for (std::int64_t i = 0; i < columns.rows() && size > 0; ++i) c[i] /= size;
    }
    return thin_svd(columns).u;
}

// Fast modes have lost digits in their compliance, by which their vectors were scaled; Rayleigh's quotient
// has the opposite strength.
void refine_fast_ones(const Space &space, Coordinates &c) {
    const std::int64_t massive = static_cast<std::int64_t>(c.lambda.size()) - c.n_massless;
    for (std::int64_t j = 0; j < massive; ++j) {
        if (!(c.lambda[j] > 1e8 * c.lambda[0]) || c.lambda[0] == 0) continue;
        double stiffness = 0, mass = 0, *y = c.y.col(j);
        for (std::int64_t i = 0; i < c.y.rows(); ++i) {
            stiffness += space.lambda[i] * y[i] * y[i];
            mass += space.mass(i) * y[i] * y[i];
        }
        if (!(mass > 0)) continue;
        c.lambda[j] = stiffness / mass;
        for (std::int64_t i = 0; i < c.y.rows(); ++i) y[i] /= std::sqrt(mass);
    }
}

// The directions whose singular value is above `least`.
Matrix above(const Svd &svd, double least) {
    const auto beyond =
        std::find_if(svd.values.begin(), svd.values.end(), [&](double s) { return !(s > least); });
    return svd.u.columns(0, beyond - svd.values.begin());
}

// Zeros in the place of the other rows.
template <class Chosen> Matrix rows_where(const Matrix &columns, Chosen chosen) {
    Matrix part(columns.rows(), columns.cols());
    for (std::int64_t j = 0; j < part.cols(); ++j)
        for (std::int64_t i = 0; i < part.rows(); ++i) part(i, j) = chosen(i) ? columns(i, j) : 0.0;
    return part;
}

} // namespace

Coordinates diagonalise(const Space &space, const Matrix &columns) {
    Coordinates c;
    if (columns.cols() == 0) {
        c.y = columns;
        return c;
    }
    const double sigma = rigid_shift(space);
    const double reach = space.n_massless > 0 ? std::sqrt(space.lambda.back()) : 0;
    vector<double> root(space.size());
    for (std::int64_t i = 0; i < space.size(); ++i)
        root[i] = std::sqrt(space.lambda[i] + sigma * space.mass(i));
    Matrix q = energy_orthonormal(columns, root), inertia = q;
    for (std::int64_t j = 0; j < q.cols(); ++j)
        for (std::int64_t i = 0; i < q.rows(); ++i) {
            q(i, j) /= root[i];
            inertia(i, j) = space.mass(i) * q(i, j);
        }
    const SymmetricEigen e =
        symmetric_eigen(product('T', 'N', inertia, inertia)); // symmetric to the last bit
    RitzVectors ritz = ritz_vectors(e.values, e.vectors, sigma, reach);
    c.y = product('N', 'N', q, ritz.vectors);
    c.lambda = std::move(ritz.lambda);
    c.n_massless = ritz.n_massless;
    refine_fast_ones(space, c);
    return c;
}

Matrix coordinates_among(const Space &space, const Matrix &y, const Coordinates &basis) {
    Matrix momenta = y;
    for (std::int64_t k = 0; k < y.cols(); ++k)
        for (std::int64_t i = 0; i < y.rows(); ++i) momenta(i, k) *= space.mass(i);
    Matrix c = product('T', 'N', basis.y, momenta);
    if (basis.n_massless == 0) return c;
    Matrix elastic = y;
    for (std::int64_t k = 0; k < y.cols(); ++k)
        for (std::int64_t i = 0; i < y.rows(); ++i) elastic(i, k) *= space.lambda[i];
    const Matrix works = product('T', 'N', basis.y, elastic);
    for (std::int64_t k = 0; k < c.cols(); ++k)
        for (std::int64_t j = c.rows() - basis.n_massless; j < c.rows(); ++j)
            c(j, k) = works(j, k) / basis.lambda[j];
    return c;
}

Matrix rigid_apart(const Space &space, const Matrix &columns, double least) {
    const auto is_rigid = [&](std::int64_t i) { return space.lambda[i] == 0; };
    Matrix kept = above(thin_svd(rows_where(columns, is_rigid)), least);
    kept.append(above(thin_svd(rows_where(columns, [&](std::int64_t i) { return !is_rigid(i); })), least));
    return kept;
}

Conditioned condition_columns(const Space &space, const Matrix &columns, double tolerance) {
    Conditioned result; // in the M-inner product, since coordinates with mass are M-orthonormal
    const Svd all = thin_svd(columns);
    const double largest = all.values.empty() ? 0 : all.values.front();
    if (!(largest > 0))
        throw Error(status::internal, "the collected modes have no direction")
            .reason(reason::basis_too_small);
    for (double s : all.values) result.singular_values.push_back(s / largest);
    result.coordinates = diagonalise(space, rigid_apart(space, columns, tolerance * largest));
    return result;
}

} // namespace plm
