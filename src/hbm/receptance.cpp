#include "hbm/receptance.hpp"
#include <cmath>

namespace plm {

using Complex = std::complex<double>;

void Receptance::update(const ReducedModel &m, std::int64_t h, double omega, double self_excitation) {
    model_ = &m;
    const double w = static_cast<double>(h) * omega;
    const std::int64_t r = m.size();
    derivative_.resize(r);
    diagonal_.resize(r);
    for (std::int64_t j = 0; j < r; ++j) {
        const double c = m.damping.empty() ? m.damping_diagonal[j] : 0.0;
        diagonal_[j] =
            Complex(m.lambda[j] - w * w * m.mass(j),
                    w * (c - 2 * self_excitation * omega * m.mass(j)) + m.structural * m.lambda[j]);
        derivative_[j] = static_cast<double>(h) * Complex(-2 * w * m.mass(j), c); // d(1/D)/d omega
    }
    harmonic_ = static_cast<double>(h);
    if (m.damping.empty()) {
        for (Complex &d : diagonal_) {
            if (d == 0.0)
                throw Error(
                    status::singular,
                    format(
                        "an undamped mode of the open structure is driven exactly at its frequency, %.9g Hz "
                        "(harmonic %lld); give it damping or another frequency",
                        w / (2 * M_PI), static_cast<long long>(h)))
                    .reason(reason::singular);
            d = 1.0 / d;
        }
        return;
    }
    full_.resize(r * r);
    for (std::int64_t j = 0; j < r; ++j)
        for (std::int64_t i = 0; i < r; ++i)
            full_[i + j * r] = Complex(0, w * m.damping(i, j)) + (i == j ? diagonal_[j] : Complex(0));
    lu_.factor(r, full_);
}

void Receptance::apply(Complex *v) const {
    if (!model_->damping.empty()) return lu_.solve(v, 1, model_->size());
    for (std::size_t j = 0; j < diagonal_.size(); ++j) v[j] *= diagonal_[j];
}

void Receptance::derivative(const Complex *v, Complex *out) const {
    const std::int64_t r = model_->size();
    for (std::int64_t j = 0; j < r; ++j) out[j] = derivative_[j] * v[j];
    if (model_->damping.empty()) return;
    for (std::int64_t j = 0; j < r; ++j)
        for (std::int64_t i = 0; i < r; ++i) out[i] += Complex(0, harmonic_ * model_->damping(i, j)) * v[j];
}

void Receptance::contact_receptance(const Matrix &rows, Matrix &real, Matrix &imag) {
    const std::int64_t n = rows.rows(), r = rows.cols();
    scaled_real_.reset(n, r);
    scaled_imag_.reset(n, r);
    if (model_->damping.empty()) {
        for (std::int64_t j = 0; j < r; ++j)
            for (std::int64_t i = 0; i < n; ++i) {
                scaled_real_(i, j) = rows(i, j) * diagonal_[j].real();
                scaled_imag_(i, j) = rows(i, j) * diagonal_[j].imag();
            }
    } else {
        vector<Complex> &x = solved_;
        x.resize(r * n);
        for (std::int64_t j = 0; j < r; ++j)
            for (std::int64_t i = 0; i < n; ++i) x[j + i * r] = rows(i, j);
        lu_.solve(x.data(), n, r);
        for (std::int64_t j = 0; j < r; ++j)
            for (std::int64_t i = 0; i < n; ++i) {
                scaled_real_(i, j) = x[j + i * r].real();
                scaled_imag_(i, j) = x[j + i * r].imag();
            }
    }
    real.reset(n, n);
    imag.reset(n, n);
    gemm('N', 'T', 1.0, scaled_real_, rows, 0.0, real);
    gemm('N', 'T', 1.0, scaled_imag_, rows, 0.0, imag);
}

} // namespace plm
