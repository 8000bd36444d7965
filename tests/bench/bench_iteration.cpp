// Cost of one Newton iteration in reduced coordinates (residual, Jacobian, factorization, one solution):
// medians over many runs for 90 pairs and 5 harmonics, with the flops that the loop needs. Not a test: prints
// Markdown.
#include "hbm/make_system.hpp"
#include "hbm/options.hpp"
#include "hbm/system.hpp"
#include "searches/start.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

namespace {

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

double median_milliseconds(std::int64_t r, std::int64_t pairs, std::int64_t harmonics) {
    const auto m = synthetic(r, pairs);
    plm::HbmOptions o;
    o.n_harmonics = harmonics;
    const auto system = plm::make_modal_system(m, o);
    plm::vector<double> x(system->size()), b(system->size());
    system->linear_response(plm::coupling_at_rest(*m), 1.0, x.data());
    std::vector<double> times;
    for (int k = 0; k < 201; ++k) {
        const auto begin = std::chrono::steady_clock::now();
        system->residual(x.data(), 1.0, b.data());
        system->linearize();
        system->solve(b.data(), 1);
        times.push_back(1e3 *
                        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    std::nth_element(times.begin(), times.begin() + 100, times.end());
    return times[100];
}

} // namespace

int main() {
    const std::int64_t pairs = 90, harmonics = 5;
    std::printf("residual + Jacobian + factorization + solve, Z = %d, H = %d\n\n| r | unknowns | median ms | "
                "Mflop |\n"
                "|---|---|---|---|\n",
                static_cast<int>(pairs), static_cast<int>(harmonics));
    for (std::int64_t r : {8, 10, 16, 24, 42, 60}) {
        const double n = static_cast<double>(r * (2 * harmonics + 1)), size = static_cast<double>(r);
        const double flops =
            2.0 / 3 * n * n * n + static_cast<double>((4 * harmonics + 1) * pairs) * size * (size + 1);
        std::printf("| %d | %d | %.3f | %.1f |\n", static_cast<int>(r), static_cast<int>(n),
                    median_milliseconds(r, pairs, harmonics), 1e-6 * flops);
    }
    return 0;
}
