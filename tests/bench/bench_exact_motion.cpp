// What a step of Newton's method for an exact motion costs (a run of the flow over the period, the monodromy,
// a factorization), what the cost model of motion = auto takes it for, and what it chooses: medians at the
// highest point of the scenes' curves. Not a test: prints Markdown.
#include "hbm/make_system.hpp"
#include "median.hpp"
#include "motions/motion_measures.hpp"
#include "orbits/orbit_cost.hpp"
#include "orbits/orbit_point.hpp"
#include "orbits/orbit_points.hpp"
#include "scene_basis.hpp"
#include "searches/hbm.hpp"
#include "searches/motion_choice.hpp"
#include <chrono>
#include <cstdio>
#include <functional>

namespace {

using Model = std::shared_ptr<const plm::ReducedModel>;

double median_milliseconds(const std::function<void()> &step) {
    constexpr int runs = 11;
    std::vector<double> times;
    for (int k = 0; k < runs; ++k) {
        const auto begin = std::chrono::steady_clock::now();
        step();
        times.push_back(1e3 *
                        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    return median(std::move(times));
}

// The highest point of a curve of five harmonics.
plm::BranchPoint highest(const Model &model, plm::HbmOptions options) {
    options.motion = plm::MotionKind::harmonics;
    options.n_harmonics = 5;
    options.stability = plm::StabilityKind::off;
    const auto curve = plm::Hbm(model, 0, 0, options, plm::Watch()).sweep();
    return curve->points()[static_cast<std::size_t>(plm::largest_response(*curve))];
}

double harmonic_step(const Model &model, plm::HbmOptions options, const plm::BranchPoint &at) {
    options.n_harmonics = 20;
    const auto system = plm::make_system(model, options);
    plm::vector<double> x(static_cast<std::size_t>(system->size())), r(x.size());
    system->from_point(at, x.data());
    return median_milliseconds([&] {
        system->residual(x.data(), at.omega, r.data());
        system->linearize();
        system->solve(r.data(), 1);
    });
}

void print_row(const char *name, const Model &model, const plm::HbmOptions &options) {
    plm::BranchPoint point = highest(model, options);
    const double harmonics = harmonic_step(model, options, point);
    plm::NewtonWork work;
    if (!plm::make_exact(model, options, plm::Watch(), point, work)) {
        std::printf("| %s | %lld | %lld | no exact motion found | | | | |\n", name,
                    static_cast<long long>(model->size()), static_cast<long long>(model->n_pairs()));
        return;
    }
    plm::OrbitEquations equations =
        plm::orbit_equations(model, options, point.omega, plm::FlowParameter::frequency);
    plm::vector<double> x = plm::orbit_unknowns(equations, point, 1), r(x.size());
    double turn = 0;
    const double measured = median_milliseconds([&] {
        turn += 1e-13; // a new run of the flow
        equations.residual(x.data(), point.omega * (1 + turn), r.data());
        equations.linearize();
        equations.solve(r.data(), 1);
    });
    const double flops = plm::exact_step_flops(*model, options);
    std::printf("| %s | %lld | %lld | %lld | %.3g | %.3g | %.3g | %.3g | %s |\n", name,
                static_cast<long long>(model->size()), static_cast<long long>(model->n_pairs()),
                static_cast<long long>(equations.piece()), measured, 1e-6 * flops, 1e-6 * flops / measured,
                harmonics, plm::prefers_exact(*model, options) ? "exact" : "harmonics");
    std::fflush(stdout);
}

void run(const char *scene_name, const char *size, bool preload) {
    const SceneBasis made(scene_name, size, preload);
    const auto core = made.core;
    if (!core) return;
    plm::HbmOptions options;
    options.frequency_min_hz = core->window_min_hz();
    options.frequency_max_hz = core->window_max_hz();
    char name[80];
    std::snprintf(name, sizeof name, "%s, %s%s", scene_name, size, preload ? ", pre-load" : "");
    print_row(name, core->reduced(), options);
}

} // namespace

int main() {
    std::printf(
        "| scene | r | pairs | contact intervals | exact step (ms) | by the cost model (Mflop) | Gflop/s | "
        "step of 20 harmonics (ms) | motion = auto |\n|---|--:|--:|--:|--:|--:|--:|--:|---|\n");
    for (const bool preload : {false, true}) {
        run("bilinear_oscillator", "quick", preload);
        run("cracked_plate", "quick", preload);
        run("cracked_plate", "paper", preload);
        run("coaxial_cylinders", "quick", preload);
    }
    return 0;
}
