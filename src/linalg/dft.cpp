#include "dft.hpp"
#include "blas_lapack.hpp"
#include "dft_plan.hpp"
#include "work.hpp"
#include <algorithm>

namespace plm {
namespace {

#ifdef PLM_WITH_FFTW
constexpr bool with_fftw = true;
#else
constexpr bool with_fftw = false;
#endif
/// Up to here the matrix product wins (and it serves all signals at once).
constexpr std::int64_t product_harmonics = 16;

/// Synthesis matrix: n_samples x (2H + 1). Angles are reduced in integers, so that high harmonics stay exact.
Matrix synthesis_matrix(std::int64_t n_harmonics, std::int64_t n_samples) {
    const double two_pi = 6.283185307179586476925;
    vector<double> cosine(n_samples), sine(n_samples);
    for (std::int64_t k = 0; k < n_samples; ++k) {
        const double angle = two_pi * static_cast<double>(k) / static_cast<double>(n_samples);
        cosine[k] = std::cos(angle);
        sine[k] = std::sin(angle);
    }
    Matrix s(n_samples, 2 * n_harmonics + 1);
    std::fill_n(s.col(0), n_samples, 1.0);
    for (std::int64_t h = 1; h <= n_harmonics; ++h) {
        worked(20.0 * static_cast<double>(n_samples));
        for (std::int64_t k = 0; k < n_samples; ++k) {
            s(k, 2 * h - 1) = cosine[h * k % n_samples];
            s(k, 2 * h) = sine[h * k % n_samples];
        }
    }
    return s;
}

/// The inverse: the columns of the synthesis matrix are orthogonal with squared norm n (constant) or n / 2.
Matrix analysis_matrix(const Matrix &synthesis) {
    Matrix a = synthesis.transposed();
    const double scale = 1.0 / static_cast<double>(synthesis.rows());
    for (std::int64_t k = 0; k < a.cols(); ++k)
        for (std::int64_t i = 0; i < a.rows(); ++i) a(i, k) *= i == 0 ? scale : 2 * scale;
    return a;
}

} // namespace

struct Dft::Impl {
    std::int64_t n_harmonics, n_samples;
    Matrix synthesis, analysis;
#ifdef PLM_WITH_FFTW
    std::unique_ptr<FftwPlan> plan;

    void synthesize(const double *coefficients, double *samples) const {
        double *spectrum = plan->spectrum();
        spectrum[0] = coefficients[0];
        spectrum[1] = 0;
        for (std::int64_t h = 1; h <= n_harmonics; ++h) { // a cos + b sin = Re((a - i b) exp(i h t))
            spectrum[2 * h] = 0.5 * coefficients[2 * h - 1];
            spectrum[2 * h + 1] = -0.5 * coefficients[2 * h];
        }
        std::fill(spectrum + 2 * (n_harmonics + 1), spectrum + 2 * (n_samples / 2 + 1), 0.0);
        plan->synthesize();
        std::copy_n(plan->samples(), n_samples, samples);
    }
    void analyse(const double *samples, double *coefficients) const {
        const double scale = 1.0 / static_cast<double>(n_samples);
        std::copy_n(samples, n_samples, plan->samples());
        plan->analyse();
        const double *spectrum = plan->spectrum();
        coefficients[0] = scale * spectrum[0];
        for (std::int64_t h = 1; h <= n_harmonics; ++h) {
            coefficients[2 * h - 1] = 2 * scale * spectrum[2 * h];
            coefficients[2 * h] = -2 * scale * spectrum[2 * h + 1];
        }
    }
#endif
};

Dft::Dft(std::int64_t n_harmonics, std::int64_t n_samples) {
    if (n_harmonics < 0) throw Error(status::argument, "Dft: number of harmonics is negative");
    if (n_samples > INT_MAX || n_samples / 2 < n_harmonics || n_samples < 2 * n_harmonics + 1)
        throw Error(status::argument,
                    format("Dft: %lld harmonics need at least 2 * %lld + 1 time samples, not %lld",
                           static_cast<long long>(n_harmonics), static_cast<long long>(n_harmonics),
                           static_cast<long long>(n_samples)));
    impl_ = std::make_unique<Impl>();
    impl_->n_harmonics = n_harmonics;
    impl_->n_samples = n_samples;
    if (!with_fftw || n_harmonics <= product_harmonics) {
        impl_->synthesis = synthesis_matrix(n_harmonics, n_samples);
        impl_->analysis = analysis_matrix(impl_->synthesis);
        return;
    }
#ifdef PLM_WITH_FFTW
    impl_->plan = std::make_unique<FftwPlan>(n_samples);
#endif
}

Dft::~Dft() = default;
std::int64_t Dft::n_harmonics() const {
    return impl_->n_harmonics;
}
std::int64_t Dft::n_samples() const {
    return impl_->n_samples;
}

void Dft::to_time(const Matrix &coefficients, Matrix &samples) const {
    require(coefficients.rows() == 2 * n_harmonics() + 1, "Dft::to_time: rows");
    samples.reset(n_samples(), coefficients.cols());
    if (!impl_->synthesis.empty()) return gemm('N', 'N', 1, impl_->synthesis, coefficients, 0, samples);
#ifdef PLM_WITH_FFTW
    for (std::int64_t j = 0; j < samples.cols(); ++j) impl_->synthesize(coefficients.col(j), samples.col(j));
#endif
}

void Dft::to_frequency(const Matrix &samples, Matrix &coefficients) const {
    require(samples.rows() == n_samples(), "Dft::to_frequency: rows");
    coefficients.reset(2 * n_harmonics() + 1, samples.cols());
    if (!impl_->analysis.empty()) return gemm('N', 'N', 1, impl_->analysis, samples, 0, coefficients);
#ifdef PLM_WITH_FFTW
    for (std::int64_t j = 0; j < samples.cols(); ++j) impl_->analyse(samples.col(j), coefficients.col(j));
#endif
}

std::string dft_backend() {
#ifdef PLM_WITH_FFTW
    return fftw_name();
#else
    return "matrix product";
#endif
}

} // namespace plm
