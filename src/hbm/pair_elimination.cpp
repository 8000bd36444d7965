#include "hbm/pair_elimination.hpp"
#include <algorithm>

namespace plm {
namespace {

using Complex = PairElimination::Complex;

Matrix part(const vector<Complex> &a, std::int64_t rows, std::int64_t cols, bool imaginary) {
    Matrix m(rows, cols);
    for (std::int64_t k = 0; k < rows * cols; ++k) m.data()[k] = imaginary ? a[k].imag() : a[k].real();
    return m;
}

// (real + i imag) -= A B with A s x n and B n x s
void subtract_product(const vector<Complex> &a, const vector<Complex> &b, std::int64_t s, std::int64_t n,
                      Matrix &real, Matrix &imag) {
    const Matrix ar = part(a, s, n, false), ai = part(a, s, n, true);
    const Matrix br = part(b, n, s, false), bi = part(b, n, s, true);
    gemm('N', 'N', -1.0, ar, br, 1.0, real);
    gemm('N', 'N', 1.0, ai, bi, 1.0, real);
    gemm('N', 'N', -1.0, ar, bi, 1.0, imag);
    gemm('N', 'N', -1.0, ai, br, 1.0, imag);
}

Matrix leading_block(const Matrix &a, std::int64_t size) {
    Matrix block(size, size);
    for (std::int64_t j = 0; j < size; ++j) std::copy_n(a.col(j), size, block.col(j));
    return block;
}

} // namespace

void PairElimination::build(const Matrix &real, const Matrix &imag, std::int64_t n_moving,
                            const vector<double> &kappa) {
    const std::int64_t s = n_moving, n = static_cast<std::int64_t>(kappa.size());
    n_moving_ = s;
    n_eliminated_ = n;
    real_ = leading_block(real, s);
    imag_ = leading_block(imag, s);
    if (n == 0) return;
    vector<Complex> matrix(n * n);
    to_eliminated_.resize(n * s);
    from_eliminated_.resize(s * n);
    for (std::int64_t j = 0; j < n; ++j) {
        for (std::int64_t i = 0; i < n; ++i)
            matrix[i + j * n] =
                Complex(real(s + i, s + j), imag(s + i, s + j)) * kappa[j] + (i == j ? 1.0 : 0.0);
        for (std::int64_t i = 0; i < s; ++i) {
            from_eliminated_[i + j * s] = Complex(real(i, s + j), imag(i, s + j)) * kappa[j];
            to_eliminated_[j + i * n] = Complex(real(s + j, i), imag(s + j, i));
        }
    }
    constant_.factor(n, matrix);
    if (s == 0) return;
    vector<Complex> x = to_eliminated_; // (I + G_EE kappa)^-1 G_ES
    constant_.solve(x.data(), s, n);
    subtract_product(from_eliminated_, x, s, n, real_, imag_);
}

void PairElimination::condense(vector<Complex> &held, Complex *moving) const {
    if (n_eliminated_ == 0) return;
    constant_.solve(held.data(), 1, n_eliminated_);
    for (std::int64_t j = 0; j < n_eliminated_; ++j)
        for (std::int64_t p = 0; p < n_moving_; ++p)
            moving[p] -= from_eliminated_[p + j * n_moving_] * held[j];
}

void PairElimination::expand(const vector<Complex> &y, vector<Complex> &held) const {
    if (n_eliminated_ == 0) return;
    vector<Complex> coupled(n_eliminated_);
    for (std::int64_t p = 0; p < n_moving_; ++p)
        for (std::int64_t j = 0; j < n_eliminated_; ++j)
            coupled[j] += to_eliminated_[j + p * n_eliminated_] * y[p];
    constant_.solve(coupled.data(), 1, n_eliminated_);
    for (std::int64_t j = 0; j < n_eliminated_; ++j) held[j] -= coupled[j];
}

} // namespace plm
