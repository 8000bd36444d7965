#include "dft_plan.hpp"
#ifdef PLM_CARRIED_FFTW
#include "carried/fftw_parts.hpp"
#endif
#include <fftw3.h>
#include <mutex>
#include <new>

namespace plm {
namespace {

std::mutex &planner() { // FFTW's planner is the only part of it that is not thread-safe
    static std::mutex mutex;
    return mutex;
}

/// FFTW knows no failing malloc: it ends the process. A carried one is not begun without memory.
void require_memory(std::int64_t n_samples) {
#ifdef PLM_CARRIED_FFTW
    // measured for all n up to 3,000 and some up to 70,000: 212 kB for the planner and 131 n for a transform
    if (!carried_fftw_may_work(512 * 1024 + 256 * static_cast<std::size_t>(n_samples)))
        throw std::bad_alloc();
#else
    (void)n_samples;
#endif
}

} // namespace

FftwPlan::FftwPlan(std::int64_t n_samples)
    : samples_(n_samples), spectrum_(2 * (static_cast<std::size_t>(n_samples) / 2 + 1)) {
    const int n = static_cast<int>(n_samples);
    auto *spectrum = reinterpret_cast<fftw_complex *>(spectrum_.data());
    require_memory(n_samples);
    const std::lock_guard<std::mutex> lock(planner());
    // FFTW_ESTIMATE: a measured plan would make results depend on the timing of this run.
    forward_ = fftw_plan_dft_r2c_1d(n, samples_.data(), spectrum, FFTW_ESTIMATE);
    backward_ = fftw_plan_dft_c2r_1d(n, spectrum, samples_.data(), FFTW_ESTIMATE);
    if (forward_ && backward_) return;
    if (forward_) fftw_destroy_plan(static_cast<fftw_plan>(forward_));
    if (backward_) fftw_destroy_plan(static_cast<fftw_plan>(backward_));
    throw std::bad_alloc();
}

FftwPlan::~FftwPlan() {
    const std::lock_guard<std::mutex> lock(planner());
    fftw_destroy_plan(static_cast<fftw_plan>(forward_));
    fftw_destroy_plan(static_cast<fftw_plan>(backward_));
}

void FftwPlan::analyse() {
    fftw_execute(static_cast<fftw_plan>(forward_));
}
void FftwPlan::synthesize() {
    fftw_execute(static_cast<fftw_plan>(backward_));
}

std::string fftw_name() {
    const std::string version = fftw_version; // "fftw-3.3.10-sse2-avx"
    const auto begin = version.find('-'), end = version.find('-', begin + 1);
    return "FFTW " + version.substr(begin + 1, end - begin - 1);
}

} // namespace plm
