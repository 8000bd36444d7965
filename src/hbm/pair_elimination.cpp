#include "hbm/pair_elimination.hpp"
#include <algorithm>

namespace plm {

void PairElimination::build(const Matrix &real, const Matrix &imag, std::int64_t n_moving,
                            const vector<double> &kappa) {
    const std::int64_t s = n_moving, n = static_cast<std::int64_t>(kappa.size());
    n_moving_ = s;
    n_eliminated_ = n;
    moving_.reset(s, s);
    for (std::int64_t j = 0; j < s; ++j) {
        std::copy_n(real.col(j), s, moving_.real.col(j));
        std::copy_n(imag.col(j), s, moving_.imag.col(j));
    }
    if (n == 0) return;
    matrix_.resize(n * n);
    forces_.reset(s, n);
    for (std::int64_t j = 0; j < n; ++j) {
        for (std::int64_t i = 0; i < n; ++i)
            matrix_[i + j * n] =
                Complex(real(s + i, s + j), imag(s + i, s + j)) * kappa[j] + (i == j ? 1.0 : 0.0);
        for (std::int64_t i = 0; i < s; ++i)
            forces_.set(i, j, Complex(real(i, s + j), imag(i, s + j)) * kappa[j]);
    }
    constant_.factor(n, matrix_);
    if (s == 0) return;
    solved_.resize(n * s);
    for (std::int64_t i = 0; i < s; ++i)
        for (std::int64_t j = 0; j < n; ++j) solved_[j + i * n] = Complex(real(s + j, i), imag(s + j, i));
    constant_.solve(solved_.data(), s, n);
    response_.reset(n, s);
    for (std::int64_t i = 0; i < s; ++i)
        for (std::int64_t j = 0; j < n; ++j) response_.set(j, i, solved_[j + i * n]);
    gemm('N', 'N', -1.0, forces_.real, response_.real, 1.0, moving_.real);
    gemm('N', 'N', 1.0, forces_.imag, response_.imag, 1.0, moving_.real);
    gemm('N', 'N', -1.0, forces_.real, response_.imag, 1.0, moving_.imag);
    gemm('N', 'N', -1.0, forces_.imag, response_.real, 1.0, moving_.imag);
}

void PairElimination::condense(vector<Complex> &held, Complex *moving) {
    if (n_eliminated_ == 0) return;
    constant_.solve(held.data(), 1, n_eliminated_);
    subtract_product(forces_, held.data(), moving);
}

void PairElimination::expand(const vector<Complex> &y, vector<Complex> &held) {
    if (n_eliminated_ == 0 || n_moving_ == 0) return;
    subtract_product(response_, y.data(), held.data());
}

// out -= a v
void PairElimination::subtract_product(const Parts &a, const Complex *v, Complex *out) {
    const std::int64_t rows = a.real.rows(), cols = a.real.cols();
    in_.reset(cols, 2);
    out_.reset(rows, 2);
    for (std::int64_t j = 0; j < cols; ++j) in_(j, 0) = v[j].real(), in_(j, 1) = v[j].imag();
    gemm('N', 'N', 1.0, a.real, in_, 0.0, out_);
    gemv('N', -1.0, a.imag, in_.col(1), 1.0, out_.col(0));
    gemv('N', 1.0, a.imag, in_.col(0), 1.0, out_.col(1));
    for (std::int64_t i = 0; i < rows; ++i) out[i] -= Complex(out_(i, 0), out_(i, 1));
}

} // namespace plm
