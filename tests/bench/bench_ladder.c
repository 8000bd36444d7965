/* What accuracy and effort buy: the one call on a scene of the examples for several of both, each with what
 * it took, what it found, its own estimate of the error, and how far it is from the answer of the smallest
 * accuracy. bench_ladder [SCENE [quick|paper [no-preload]]] Without arguments: the small scenes, with and
 * without pre-load. Prints Markdown. */
#include "scene_model.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* The last one is what the others are held against: the one without a limit of effort. */
static const struct {
    double accuracy, effort; /* s; 0: no limit */
} rungs[] = {{1e-2, 10}, {1e-3, 10}, {1e-4, 10}, {1e-5, 10}, {1e-3, 1}, {1e-3, 3}, {1e-3, 30}, {1e-5, 120}};
enum { n_rungs = sizeof rungs / sizeof *rungs };

typedef struct answer {
    double seconds, hz, amplitude, error;
    int64_t basis, points;
    plm_status status;
} answer;

static answer ask(const scene *s, double accuracy, double effort) {
    plm_context *context = NULL;
    plm_model *model = NULL;
    plm_branch *curve = NULL;
    answer a = {0, 0, 0, 0, 0, 0, PLM_OK};
    must(NULL, plm_context_create(PLM_API_VERSION, &context), "context");
    must(context, plm_context_set_effort(context, effort), "effort");
    must(context, scene_to_model(context, s, &model), "model");
    const clock_t begin = clock();
    a.status = plm_model_compute_response(model, s->output_dof, PLM_HALF_PEAK_TO_PEAK, accuracy, &a.hz,
                                          &a.amplitude, &a.error, &curve, NULL);
    a.seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    must(context, a.status, "compute_response");
    must(context, plm_branch_get_int(curve, "basis_size", &a.basis), "basis_size");
    must(context, plm_branch_get_int(curve, "n_points", &a.points), "n_points");
    plm_context_destroy(&context);
    return a;
}

static void run(const char *name, const char *size, int with_preload) {
    scene *s = NULL;
    answer found[n_rungs];
    if (scene_create(name, size, with_preload, &s)) {
        fprintf(stderr, "no scene %s, %s\n", name, size);
        exit(1);
    }
    for (int k = 0; k < n_rungs; k++) found[k] = ask(s, rungs[k].accuracy, rungs[k].effort);
    printf("\n%s, %s%s: %lld DOFs, %lld pairs\n\n", name, size, with_preload ? ", pre-load" : "",
           (long long)s->n_dof, (long long)s->n_pairs);
    printf("| accuracy | effort (s) | took (s) | r | points | Hz | amplitude | stated | from the last | "
           "status |\n"
           "|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (int k = 0; k < n_rungs; k++) {
        const answer *a = &found[k], *last = &found[n_rungs - 1];
        printf("| %.0e | %g | %.2f | %lld | %lld | %.6g | %.6g | %.1e | %.1e | %d |\n", rungs[k].accuracy,
               rungs[k].effort, a->seconds, (long long)a->basis, (long long)a->points, a->hz, a->amplitude,
               a->error, fabs(a->amplitude / last->amplitude - 1), (int)a->status);
    }
    fflush(stdout);
    scene_destroy(&s);
}

int main(int count, char **argument) {
    if (count > 1) {
        run(argument[1], count > 2 ? argument[2] : "quick",
            count < 4 || strcmp(argument[3], "no-preload") != 0);
        return 0;
    }
    for (int k = 0; k < scene_count(); k++)
        for (int with_preload = 0; with_preload < 2; with_preload++)
            run(scene_name(k), "quick", with_preload);
    return 0;
}
