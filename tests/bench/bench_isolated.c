/* The isolated branch of tests/searches/test_isolated_plate.cpp through the C API: a cracked plate, closed at
 * rest by an even pressure on its end, with nothing set but the range of the curve and the force. Prints
 * Markdown: seconds of the processor, what was found. */
#include "cracked_plate.h"
#include "scene_model.h"
#include <stdio.h>
#include <time.h>

static double seconds(void) {
    static clock_t begin;
    const clock_t now = clock(), before = begin;
    begin = now;
    return (double)(now - before) / CLOCKS_PER_SEC;
}

static scene *plate(void) {
    cracked_plate_params p;
    scene *s = NULL;
    cracked_plate_isolated(&p);
    if (cracked_plate_create(&p, &s)) fprintf(stderr, "no plate\n");
    return s;
}

/* Coordinates that the branch was followed in, whether it closes, its folds and where it is unstable. */
static void print_branch(plm_context *context, const char *name, plm_branch *branch, double spent) {
    static int64_t kind[4000], stable[4000];
    int64_t n = 0, n_stable = 0, reason = 0, folds = 0, unstable = 0;
    must(context, plm_branch_get_int_array(branch, "bifurcation", 4000, kind, &n), "bifurcation");
    must(context, plm_branch_get_int_array(branch, "stable", 4000, stable, &n_stable), "stable");
    must(context, plm_branch_get_int(branch, "end_reason", &reason), "end_reason");
    for (int64_t i = 0; i < n; i++) folds += kind[i] == PLM_BIFURCATION_FOLD, unstable += stable[i] == 0;
    printf("| %s | %.2f | %lld | %s | %lld | %lld |", name, spent, (long long)n,
           reason == PLM_REASON_LOOP_CLOSED ? "yes" : "no", (long long)folds, (long long)unstable);
}

int main(void) {
    plm_context *c = NULL;
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL;
    int64_t found = 0;
    scene *s = plate();
    if (!s) return 1;
    must(NULL, plm_context_create(PLM_API_VERSION, &c), "context");
    must(c, scene_to_model(c, s, &model), "model");
    must(c, plm_sampler_create(model, &sampler), "sampler");
    must(c, plm_sampler_run(sampler), "sampler");
    must(c, plm_basis_create(model, &basis), "basis");
    must(c, plm_basis_set_sampler(basis, sampler), "basis");
    must(c, plm_basis_build(basis), "basis");
    must(c, plm_hbm_create(basis, &hbm), "hbm");
    must(c, plm_hbm_set_double(hbm, "frequency_min_hz", 1250), "window");
    must(c, plm_hbm_set_double(hbm, "frequency_max_hz", 2100), "window");
    must(c, plm_hbm_set_double(hbm, "force_scale", 0.3), "force");
    seconds();
    must(c, plm_hbm_sweep(hbm, &curve), "sweep");
    printf("| branch | s | points | closed | folds | unstable | exists between forces |\n"
           "|---|--:|--:|---|--:|--:|---|\n");
    print_branch(c, "curve", curve, seconds());
    printf(" |\n");
    must(c, plm_hbm_find_isolated(hbm, curve, 0, &found), "isolated");
    const double spent = seconds();
    for (int64_t i = 0; i < found; i++) {
        double range[2] = {0, 0};
        plm_branch *branch = NULL;
        must(c, plm_hbm_get_found(hbm, i, range, &branch), "found");
        print_branch(c, "isolated", branch, spent);
        printf(" %.6g, %.6g |\n", range[0], range[1]);
    }
    plm_context_destroy(&c);
    scene_destroy(&s);
    return found == 1 ? 0 : 1;
}
