// What the unreduced cracked plate costs at many harmonics, in its contact gaps: a factorization (by blocks
// where that pays, see moving_pairs.hpp) and a solution, beside the LU of the same order, at the end of the
// first points of the curve, and these points. Argument: a factor on the contact stiffness. Processor time.
// Not a test: prints Markdown.
#include "capi/handles.hpp"
#include "hbm/make_system.hpp"
#include "linalg/lapack.hpp"
#include "searches/hbm.hpp"
extern "C" {
#include "scene.h"
#include "scene_model.h"
}
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace {

using Model = std::shared_ptr<const plm::ReducedModel>;

constexpr std::int64_t first_points = 40;

template <class Work> double seconds_of(Work work) {
    const std::clock_t begin = std::clock();
    work();
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

double seconds_of_lu(std::int64_t n) {
    plm::Matrix a(n, n);
    for (std::int64_t j = 0; j < n; ++j) {
        const plm::vector<double> column = plm::patternless_vector(n);
        for (std::int64_t i = 0; i < n; ++i) a(i, j) = column[(i * (j + 1)) % n] + (i == j ? 10.0 : 0.0);
    }
    plm::RealLu lu;
    return seconds_of([&] { lu.factor(a); });
}

std::shared_ptr<const plm::Branch> curve(const Model &model, const plm::HbmOptions &options) {
    return plm::Hbm(model, 0, 0, options, plm::Watch()).sweep();
}

void print_row(const Model &model, plm::HbmOptions options, std::int64_t n_harmonics) {
    options.n_harmonics = n_harmonics;
    options.max_points = first_points;
    std::shared_ptr<const plm::Branch> branch;
    const double sweep = seconds_of([&] { branch = curve(model, options); });
    const plm::BranchPoint &last = branch->points().back();
    const auto system = plm::make_system(model, options);
    const std::int64_t n = system->size();
    plm::vector<double> x(n), r(n);
    system->from_point(last, x.data());
    system->residual(x.data(), last.omega, r.data());
    const std::int64_t order = system->indicator().n_switching * (2 * n_harmonics + 1);
    const double factor = seconds_of([&] { system->linearize(); });
    system->parameter_derivative(r.data());
    const double solution = seconds_of([&] { system->solve(r.data(), 1); });
    std::printf("| %d | %.1f (%d points) | %d | %.3f | %.3f | ", static_cast<int>(n_harmonics), sweep,
                static_cast<int>(branch->points().size()), static_cast<int>(order), factor, solution);
    std::fflush(stdout);
    std::printf("%.3f |\n", seconds_of_lu(order));
    std::fflush(stdout);
}

void run(double stiffness_factor) {
    plm_context *context = nullptr;
    scene *host = nullptr;
    plm_model *model = nullptr;
    plm_sampler *sampler = nullptr;
    plm_basis *basis = nullptr;
    must(nullptr, plm_context_create(PLM_API_VERSION, &context), "context");
    if (scene_create("cracked_plate", "paper", true, &host)) return;
    must(context, scene_to_model(context, host, &model), "model");
    must(context, plm_sampler_create(model, &sampler), "sampler");
    must(context, plm_sampler_run(sampler), "sampler");
    must(context, plm_basis_create(model, &basis), "basis");
    must(context, plm_basis_set_string(basis, "kind", "full"), "basis");
    must(context, plm_basis_set_sampler(basis, sampler), "basis");
    must(context, plm_basis_build(basis), "basis");
    const auto core = plm::capi::find<plm::capi::BasisHandle>(basis)->core;
    auto stiffer = std::make_shared<plm::ReducedModel>(*core->reduced());
    for (double &k : stiffer->contact.stiffness) k *= stiffness_factor;
    plm::HbmOptions options;
    options.frequency_min_hz = core->window_min_hz();
    options.frequency_max_hz = core->window_max_hz();
    options.motion = plm::MotionKind::harmonics;
    options.unknowns = plm::NonlinearUnknowns::gaps;
    options.stability = plm::StabilityKind::off;
    std::printf(
        "\ncontact stiffness x %g: %d pairs\n\n| H | curve (s) | order | factorization (s) | solution (s) "
        "| LU of this order (s) |\n|--:|--:|--:|--:|--:|--:|\n",
        stiffness_factor, static_cast<int>(stiffer->n_pairs()));
    for (std::int64_t n_harmonics : {10, 20, 40}) print_row(stiffer, options, n_harmonics);
    scene_destroy(&host);
    plm_context_destroy(&context);
}

} // namespace

int main(int n_arguments, char **arguments) {
    run(n_arguments > 1 ? std::atof(arguments[1]) : 1.0);
    return 0;
}
