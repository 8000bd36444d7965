// What one Newton iteration of the harmonic balance in reduced coordinates costs (residual, Jacobian,
// factorization, one solution) beside the factorization alone, with the flops that the latter needs, the same
// by LAPACK, and the rate of the machine's matrix product: processor time, medians over runs in turn. Not a
// test: prints Markdown.
#include "hbm/make_system.hpp"
#include "hbm/modal_jacobian.hpp"
#include "hbm/options.hpp"
#include "hbm/system.hpp"
#include "linalg/lapack.hpp"
#include "median.hpp"
#include "reduction/reduced_rest.hpp"
#include "support/count_allocations.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>

extern "C" void dgetrf_(const int *, const int *, double *, const int *, int *, int *);

namespace {

constexpr std::int64_t harmonics = 5;

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

class Samples {
  public:
    template <class Work> void add(Work work) {
        const double begin = processor_seconds();
        work();
        milliseconds_.push_back(1e3 * (processor_seconds() - begin));
    }
    double median() const { return ::median(milliseconds_); }

  private:
    std::vector<double> milliseconds_;
};

// A reduced model like the cracked plate's: r modes from 0.2 to 6 times the excitation, smooth gap rows.
std::shared_ptr<plm::ReducedModel> synthetic(std::int64_t r, std::int64_t pairs) {
    auto m = std::make_shared<plm::ReducedModel>();
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    m->gap.reset(pairs, r);
    for (std::int64_t j = 0; j < r; ++j) {
        const double w = 0.2 + 5.8 * static_cast<double>(j) / static_cast<double>(r);
        m->lambda.push_back(w * w);
        m->damping_diagonal.push_back(0.01 * w * w);
        for (std::int64_t i = 0; i < pairs; ++i)
            m->gap(i, j) = std::cos(0.03 * static_cast<double>((i + 1) * (j + 1))) + 0.1 * normal(random);
    }
    m->lambda_0 = m->lambda;
    m->gap_0 = m->gap;
    m->preload_0.assign(r, 0.0);
    m->excitation[1].real.assign(r, 1.0);
    m->excitation[1].imag.assign(r, 0.0);
    m->contact.stiffness.assign(pairs, 0.05);
    m->contact.initial_gap.assign(pairs, 0.0);
    return m;
}

double gflop_per_second() {
    const std::int64_t n = 512;
    plm::Matrix a(n, n), b(n, n), c(n, n);
    for (std::int64_t k = 0; k < n * n; ++k) a.data()[k] = b.data()[k] = 1.0 / static_cast<double>(k + 1);
    Samples s;
    for (int k = 0; k < 11; ++k) s.add([&] { plm::gemm('N', 'N', 1.0, a, b, 0.0, c); });
    return 2e-6 * static_cast<double>(n * n * n) / s.median();
}

void print_row(std::int64_t r, std::int64_t pairs) {
    const auto m = synthetic(r, pairs);
    plm::HbmOptions o;
    o.n_harmonics = harmonics;
    const auto system = plm::make_modal_system(m, o);
    const std::int64_t n = system->size();
    plm::vector<double> x(n), b(n);
    system->linear_response(plm::coupling_at_rest(*m), 1.0, x.data());

    Samples iteration, residual, jacobian, factor, lapack;
    plm::ModalJacobian form(m, harmonics);
    form.set_omega(1.0);
    plm::Matrix matrix, copy;
    plm::RealLu lu;
    std::vector<int> pivots(n);
    long allocations = 0;
    const int runs = n < 200 ? 401 : 41;
    for (int k = 0; k < runs; ++k) {
        const test::AllocationCount count;
        iteration.add([&] {
            system->residual(x.data(), 1.0, b.data());
            system->linearize();
            system->solve(b.data(), 1);
        });
        allocations = count.so_far();
        residual.add([&] { system->residual(x.data(), 1.0, b.data()); });
        jacobian.add([&] {
            form.set_tangent(system->indicator(), m->contact.stiffness);
            matrix.reshape(n, n);
            form.write_to(matrix);
        });
        copy = matrix;
        factor.add([&] { lu.factor(matrix); });
        const int size = static_cast<int>(n);
        int info = 0;
        lapack.add([&] { dgetrf_(&size, &size, copy.data(), &size, pivots.data(), &info); });
    }
    const double flops = 2.0 / 3 * std::pow(static_cast<double>(n), 3);
    std::printf("| %d | %d | %d | %.3f | %.3f | %.3f | %.3f | %.3f | %.1f | %.2f | %ld |\n",
                static_cast<int>(r), static_cast<int>(pairs), static_cast<int>(n), iteration.median(),
                residual.median(), jacobian.median(), factor.median(), lapack.median(), 1e-6 * flops,
                iteration.median() / lapack.median(), allocations);
}

} // namespace

int main() {
    std::printf("Newton iteration in reduced coordinates, H = %d; matrix product %.1f Gflop/s\n\n"
                "| r | Z | unknowns | iteration ms | residual | Jacobian | LU | LAPACK's LU | Mflop of it | "
                "iteration / LAPACK's LU | allocations |\n"
                "|---|---|---|---|---|---|---|---|---|---|---|\n",
                static_cast<int>(harmonics), gflop_per_second());
    for (std::int64_t pairs : {30, 90, 256})
        for (std::int64_t r : {10, 16, 24, 42, 60}) print_row(r, pairs);
    return 0;
}
