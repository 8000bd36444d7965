#include "gmres.hpp"
#include "work.hpp"
#include <cmath>

namespace plm {

bool Gmres::solve(LinearEquations &equations, std::int64_t n, double *b, double tolerance,
                  std::int64_t most_steps) {
    const double size = norm2(n, b);
    n_steps_ = 0;
    if (size == 0) return true;
    if (basis_.rows() != n || basis_.cols() != most_steps + 1) {
        basis_.reset(n, most_steps + 1);
        hessenberg_.reset(most_steps + 1, most_steps);
        cosine_.resize(most_steps);
        sine_.resize(most_steps);
        rhs_.resize(most_steps + 1);
        image_.resize(n);
    }
    rhs_[0] = size;
    for (std::int64_t i = 0; i < n; ++i) basis_(i, 0) = b[i] / size;
    for (std::int64_t k = 0; k < most_steps; ++k) {
        arnoldi_step(equations, k);
        const double left = rotate(k);
        ++n_steps_;
        if (!(left < size)) return false; // nothing was won, or no number: not by these means
        if (left > tolerance * size) continue;
        combine(equations, k + 1, b);
        return true;
    }
    return false;
}

// Column k of the Hessenberg matrix and column k + 1 of the basis, by modified Gram-Schmidt.
void Gmres::arnoldi_step(LinearEquations &equations, std::int64_t k) {
    const std::int64_t n = basis_.rows();
    double *next = basis_.col(k + 1), *h = hessenberg_.col(k);
    image_.assign(basis_.col(k), basis_.col(k) + n);
    equations.precondition(image_.data());
    equations.product(image_.data(), next);
    for (std::int64_t j = 0; j <= k; ++j) {
        const double *v = basis_.col(j);
        h[j] = dot(n, v, next);
        for (std::int64_t i = 0; i < n; ++i) next[i] -= h[j] * v[i];
    }
    h[k + 1] = norm2(n, next);
    if (h[k + 1] > 0)
        for (std::int64_t i = 0; i < n; ++i) next[i] /= h[k + 1];
    worked(4.0 * static_cast<double>(n * (k + 2)));
}

// Givens rotations make the Hessenberg matrix triangular; returns the norm of the residual that is left.
double Gmres::rotate(std::int64_t k) {
    double *h = hessenberg_.col(k);
    for (std::int64_t j = 0; j < k; ++j) {
        const double above = h[j];
        h[j] = cosine_[j] * above + sine_[j] * h[j + 1];
        h[j + 1] = cosine_[j] * h[j + 1] - sine_[j] * above;
    }
    determinant_sign_ = h[k] < 0 ? -1 : 1; // the entries above are positive, and rotations have determinant 1
    const double length = std::hypot(h[k], h[k + 1]);
    cosine_[k] = h[k] / length;
    sine_[k] = h[k + 1] / length;
    h[k] = length;
    rhs_[k + 1] = -sine_[k] * rhs_[k];
    rhs_[k] *= cosine_[k];
    return std::abs(rhs_[k + 1]);
}

// x = P^-1 V y with the least-squares solution y.
void Gmres::combine(LinearEquations &equations, std::int64_t k, double *x) {
    const std::int64_t n = basis_.rows();
    for (std::int64_t i = k - 1; i >= 0; --i) {
        for (std::int64_t j = i + 1; j < k; ++j) rhs_[i] -= hessenberg_(i, j) * rhs_[j];
        rhs_[i] /= hessenberg_(i, i);
    }
    for (std::int64_t i = 0; i < n; ++i) x[i] = 0;
    for (std::int64_t j = 0; j < k; ++j)
        for (std::int64_t i = 0; i < n; ++i) x[i] += rhs_[j] * basis_(i, j);
    equations.precondition(x);
}

} // namespace plm
