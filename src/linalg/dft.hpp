// Batched real Fourier transforms between Fourier coefficients and equidistant time samples of a period.
// Coefficient layout of one signal: a0, a1, b1, ..., aH, bH with x(t) = a0 + sum_h a_h cos h t + b_h sin h t.
#pragma once
#include "dense.hpp"
#include <memory>
#include <string>

namespace plm {

class Dft {
  public:
    /// n_harmonics >= 0, n_samples >= 2 n_harmonics + 1 (otherwise PLM_ERR_ARGUMENT).
    /// Few harmonics: matrix product; many samples: FFTW (the permissive build always multiplies).
    Dft(std::int64_t n_harmonics, std::int64_t n_samples);
    ~Dft();
    Dft(const Dft &) = delete;
    Dft &operator=(const Dft &) = delete;
    std::int64_t n_harmonics() const;
    std::int64_t n_samples() const;
    /// samples (n_samples x n_signals) = synthesis of coefficients ((2H+1) x n_signals)
    void to_time(const Matrix &coefficients, Matrix &samples) const;
    /// coefficients ((2H+1) x n_signals) = truncated analysis of samples (n_samples x n_signals)
    void to_frequency(const Matrix &samples, Matrix &coefficients) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
std::string dft_backend(); // "FFTW 3.3.10" or "matrix product"

} // namespace plm
