/* What a host that sets nothing waits for, and gets: the scenes of the examples from matrices to peak, each
 * step with the time of the processor.
 *     bench_defaults [SCENE [quick|paper [no-preload] [one-call|set-up]]]
 * Without arguments: the small scenes, with and without pre-load. Prints Markdown. */
#include "scene_model.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static clock_t stage_begin;

static double seconds(void) {
    const clock_t now = clock(), begin = stage_begin;
    stage_begin = now;
    return (double)(now - begin) / CLOCKS_PER_SEC;
}

/* The first warning, on one line. */
static void print_warning(plm_context *context, plm_status status) {
    char text[300] = "";
    if (status <= 0) return;
    plm_context_get_error_text(context, sizeof text, text, NULL);
    printf("\n  status %d: %s\n", (int)status, text);
}

/* Sampler and basis, one by one. */
static plm_basis *set_up(plm_context *context, plm_model *model) {
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    int64_t r = 0;
    must(context, plm_sampler_create(model, &sampler), "sampler");
    must(context, plm_sampler_run(sampler), "sampler");
    printf(" %.2f |", seconds());
    must(context, plm_basis_create(model, &basis), "basis");
    must(context, plm_basis_set_sampler(basis, sampler), "basis");
    must(context, plm_basis_build(basis), "basis");
    must(context, plm_basis_get_int(basis, "size", &r), "size");
    printf(" %.2f | %lld |", seconds(), (long long)r);
    return basis;
}

static void run_set_up(plm_context *context, plm_model *model, int64_t dof) {
    (void)dof;
    set_up(context, model);
    printf(" - | - | - | - | - |\n");
}

/* The same, then curve and peak. */
static void run_steps(plm_context *context, plm_model *model, int64_t dof) {
    plm_basis *basis = set_up(context, model);
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL, *peak = NULL;
    int64_t n_points = 0;
    double hz = 0, amplitude = 0;
    must(context, plm_hbm_create(basis, &hbm), "hbm");
    const plm_status swept = plm_hbm_sweep(hbm, &curve);
    must(context, swept, "sweep");
    must(context, plm_branch_get_int(curve, "n_points", &n_points), "n_points");
    printf(" %.2f | %lld |", seconds(), (long long)n_points);
    const plm_status found = plm_hbm_find_peak(hbm, curve, dof, PLM_PEAK, 0, &hz, &amplitude, &peak);
    must(context, found, "peak");
    printf(" %.2f | %.6g | %.6g |\n", seconds(), hz, amplitude);
    print_warning(context, found > 0 ? found : swept);
}

static void run_one_call(plm_context *context, plm_model *model, int64_t dof) {
    plm_branch *curve = NULL;
    plm_hbm *hbm = NULL;
    int64_t r = 0, n_points = 0;
    double hz = 0, amplitude = 0, error = 0;
    const plm_status status =
        plm_model_compute_response(model, dof, PLM_PEAK, 1e-3, &hz, &amplitude, &error, &curve, &hbm);
    must(context, status, "compute_response");
    must(context, plm_branch_get_int(curve, "basis_size", &r), "basis_size");
    must(context, plm_branch_get_int(curve, "n_points", &n_points), "n_points");
    printf(" - | - | %lld | %.2f (one call, error %.1e) | %lld | - | %.6g | %.6g |\n", (long long)r,
           seconds(), error, (long long)n_points, hz, amplitude);
    print_warning(context, status);
}

typedef void way(plm_context *context, plm_model *model, int64_t dof);

static void run(const char *name, const char *size, int with_preload, way *go_on) {
    plm_context *context = NULL;
    plm_model *model = NULL;
    scene *s = NULL;
    if (scene_create(name, size, with_preload, &s)) {
        fprintf(stderr, "no scene %s, %s\n", name, size);
        exit(1);
    }
    must(NULL, plm_context_create(PLM_API_VERSION, &context), "context");
    printf("| %s, %s%s | %lld | %lld |", name, size, with_preload ? ", pre-load" : "", (long long)s->n_dof,
           (long long)s->n_pairs);
    seconds();
    must(context, scene_to_model(context, s, &model), "model");
    printf(" %.2f |", seconds());
    go_on(context, model, s->output_dof);
    fflush(stdout);
    plm_context_destroy(&context);
    scene_destroy(&s);
}

int main(int count, char **argument) {
    printf("| scene | DOFs | pairs | model (s) | sampler (s) | basis (s) | r | curve (s) | points | peak (s) "
           "| Hz | "
           "amplitude |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    if (count > 1) {
        int with_preload = 1;
        way *go_on = run_steps;
        for (int i = 3; i < count; i++) {
            with_preload = with_preload && strcmp(argument[i], "no-preload") != 0;
            if (!strcmp(argument[i], "one-call")) go_on = run_one_call;
            if (!strcmp(argument[i], "set-up")) go_on = run_set_up;
        }
        run(argument[1], count > 2 ? argument[2] : "quick", with_preload, go_on);
        return 0;
    }
    for (int k = 0; k < scene_count(); k++)
        for (int with_preload = 0; with_preload < 2; with_preload++)
            run(scene_name(k), "quick", with_preload, run_steps);
    return 0;
}
