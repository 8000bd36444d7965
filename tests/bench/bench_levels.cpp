// What ten force levels in one call cost in curves: counted work and time of the processor, of one sweep at
// the highest level, of one in the middle, and of plm_hbm_sweep_levels; then each level against a sweep of it
// alone.
//     bench_levels [SCENE [quick|paper [no-preload] [check] [log]]]
// Not a test: prints Markdown.
#include "linalg/work.hpp"
#include "plm/plm.h"
extern "C" {
#include "scene.h"
#include "scene_model.h"
}
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <vector>

namespace {

constexpr std::int64_t n_levels = 10;

struct Cost {
    double flops, seconds;
};

template <class F> Cost cost_of(const F &f) {
    const std::int64_t work = plm::work_done();
    const std::clock_t begin = std::clock();
    f();
    return {static_cast<double>(plm::work_done() - work),
            static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC};
}

std::int64_t int_of(plm_branch *branch, const char *key) {
    std::int64_t n = 0;
    plm_branch_get_int(branch, key, &n);
    return n;
}

void print_curve(const char *name, double level, plm_branch *curve, const Cost &cost) {
    std::printf("| %s | %.3g | %lld | %lld | %lld | %.3g | %.2f |\n", name, level,
                static_cast<long long>(int_of(curve, "basis_size")),
                static_cast<long long>(int_of(curve, "n_points")),
                static_cast<long long>(int_of(curve, "newton_iterations")), 1e-9 * cost.flops, cost.seconds);
    std::fflush(stdout);
}

struct Bench {
    plm_context *context = nullptr;
    plm_basis *basis = nullptr;
    scene *parts = nullptr;

    Cost sweep(double level, plm_hbm **hbm, plm_branch **curve) const {
        must(context, plm_hbm_create(basis, hbm), "hbm");
        must(context, plm_hbm_set_double(*hbm, "force_scale", level), "force_scale");
        return cost_of([&] { must(context, plm_hbm_sweep(*hbm, curve), "sweep"); });
    }

    void peak_of(plm_hbm *hbm, plm_branch *curve, double &hz, double &amplitude) const {
        plm_branch *peak = nullptr;
        must(context,
             plm_hbm_find_peak(hbm, curve, parts->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, &hz, &amplitude,
                               &peak),
             "peak");
        plm_branch_destroy(&peak);
    }
};

void on_log(plm_context *, std::int32_t, const char *text, void *) {
    std::fprintf(stderr, "[%.2f s, %.3g Gflop] %s\n", static_cast<double>(std::clock()) / CLOCKS_PER_SEC,
                 1e-9 * static_cast<double>(plm::work_done()), text);
}

void run(const Bench &b, bool check) {
    std::vector<double> levels;
    for (std::int64_t k = 1; k <= n_levels; ++k) levels.push_back(0.1 * static_cast<double>(k));
    std::printf("| curve | force | r | points | iterations | Gflop | s |\n|---|--:|--:|--:|--:|--:|--:|\n");
    Cost of_one[2];
    const double one[] = {1.0, 0.5};
    for (int k = 0; k < 2; ++k) {
        plm_hbm *hbm = nullptr;
        plm_branch *curve = nullptr;
        of_one[k] = b.sweep(one[k], &hbm, &curve);
        print_curve("one sweep", one[k], curve, of_one[k]);
        plm_hbm_destroy(&hbm);
        plm_branch_destroy(&curve);
    }
    plm_hbm *hbm = nullptr;
    must(b.context, plm_hbm_create(b.basis, &hbm), "hbm");
    std::int64_t count = 0;
    const Cost all = cost_of(
        [&] { must(b.context, plm_hbm_sweep_levels(hbm, n_levels, levels.data(), &count), "levels"); });
    for (std::int64_t k = 0; k < count; ++k) {
        plm_branch *curve = nullptr;
        double unused[2];
        must(b.context, plm_hbm_get_found(hbm, k, unused, &curve), "found");
        double level = 0;
        plm_branch_get_double(curve, "force_scale", &level);
        print_curve("of the levels", level, curve, {NAN, NAN});
        if (check) {
            plm_hbm *alone = nullptr;
            plm_branch *other = nullptr;
            const Cost cost = b.sweep(level, &alone, &other);
            print_curve("alone", level, other, cost);
            double hz[2], amplitude[2];
            b.peak_of(hbm, curve, hz[0], amplitude[0]);
            b.peak_of(alone, other, hz[1], amplitude[1]);
            std::printf("peak %.10g Hz %.10g, alone %.10g Hz %.10g: %.1e, %.1e\n", hz[0], amplitude[0], hz[1],
                        amplitude[1], hz[0] / hz[1] - 1, amplitude[0] / amplitude[1] - 1);
            plm_hbm_destroy(&alone);
            plm_branch_destroy(&other);
        }
        plm_branch_destroy(&curve);
    }
    std::printf("\n%lld levels: %.3g Gflop, %.2f s: %.2f of the highest curve and %.2f of the middle one by "
                "work, %.2f and %.2f by time.\n",
                static_cast<long long>(count), 1e-9 * all.flops, all.seconds, all.flops / of_one[0].flops,
                all.flops / of_one[1].flops, all.seconds / of_one[0].seconds,
                all.seconds / of_one[1].seconds);
}

} // namespace

int main(int n, char **argument) {
    const char *name = n > 1 ? argument[1] : "cracked_plate", *size = n > 2 ? argument[2] : "quick";
    bool with_preload = true, check = false, log = false;
    for (int i = 3; i < n; ++i) {
        with_preload = with_preload && std::strcmp(argument[i], "no-preload") != 0;
        check = check || std::strcmp(argument[i], "check") == 0;
        log = log || std::strcmp(argument[i], "log") == 0;
    }
    Bench b;
    if (scene_create(name, size, with_preload, &b.parts)) {
        std::fprintf(stderr, "no scene %s, %s\n", name, size);
        return 1;
    }
    must(nullptr, plm_context_create(PLM_API_VERSION, &b.context), "context");
    if (log) plm_context_set_log(b.context, on_log, nullptr);
    plm_model *model = nullptr;
    plm_sampler *sampler = nullptr;
    must(b.context, scene_to_model(b.context, b.parts, &model), "model");
    must(b.context, plm_sampler_create(model, &sampler), "sampler");
    must(b.context, plm_sampler_run(sampler), "sampler");
    must(b.context, plm_basis_create(model, &b.basis), "basis");
    must(b.context, plm_basis_set_sampler(b.basis, sampler), "basis");
    must(b.context, plm_basis_build(b.basis), "basis");
    run(b, check);
    plm_context_destroy(&b.context);
    scene_destroy(&b.parts);
    return 0;
}
