// Private to linalg: one real Fourier transform of n samples by FFTW on its own aligned arrays.
#pragma once
#include "memory.hpp"
#include <cstdint>
#include <string>

namespace plm {

class FftwPlan {
  public:
    explicit FftwPlan(std::int64_t n_samples);
    ~FftwPlan();
    FftwPlan(const FftwPlan &) = delete;
    FftwPlan &operator=(const FftwPlan &) = delete;
    double *samples() { return samples_.data(); }   // n_samples
    double *spectrum() { return spectrum_.data(); } // n_samples / 2 + 1 complex numbers
    void analyse();                                 // samples -> spectrum, unscaled
    void synthesize();                              // spectrum -> samples, unscaled; destroys the spectrum

  private:
    vector<double> samples_, spectrum_;
    void *forward_ = nullptr, *backward_ = nullptr;
};
std::string fftw_name(); // "FFTW 3.3.10"

} // namespace plm
