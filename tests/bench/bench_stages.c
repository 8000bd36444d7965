/* What each stage from matrices to a response curve takes, with nothing set but what is asked here: seconds
 * of the clock on the wall and of the processor, and what the process holds at most meanwhile, the host's
 * matrices among it (Linux). Cracked cantilevers as in bench_scale. bench_stages solid|plate DOFS PAIRS
 * [--threads N] [--limit MIB] [--precision auto|double|single] Prints Markdown. */
#include "cantilever.h"
#include "scene_model.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct stages {
    char name[64];
    double wall, processor; /* when it began */
} stages;

static double seconds_of(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* MiB at most since the last call. */
static double peak_mebibytes(void) {
    char line[256];
    double kibibytes = 0;
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "VmHWM: %lf", &kibibytes) == 1) break;
    if (file) fclose(file);
    file = fopen("/proc/self/clear_refs", "w");
    if (file) {
        fputs("5", file); /* the peak starts anew */
        fclose(file);
    }
    return kibibytes / 1024;
}

static void enter(stages *s, const char *name) {
    if (strcmp(s->name, name) == 0) return;
    const double wall = seconds_of(CLOCK_MONOTONIC), processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    const double mebibytes = peak_mebibytes();
    if (s->name[0])
        printf("| %s | %.1f | %.1f | %.0f |\n", s->name, wall - s->wall, processor - s->processor, mebibytes);
    fflush(stdout);
    s->wall = wall, s->processor = processor;
    snprintf(s->name, sizeof s->name, "%s", name);
}

static int32_t on_progress(plm_context *context, const char *stage, double fraction, void *user) {
    (void)context, (void)fraction;
    enter((stages *)user, stage);
    return 0;
}

static void on_log(plm_context *context, int32_t level, const char *text, void *user) {
    (void)context, (void)user;
    fprintf(stderr, "%d: %s\n", (int)level, text);
}

static plm_model *build(plm_context *context, const scene *s, double limit, const char *precision) {
    plm_model *m = NULL;
    must(context, scene_to_unbuilt_model(context, s, &m), "model");
    if (limit > 0) must(context, plm_model_set_double(m, "memory_limit", limit), "memory_limit");
    must(context, plm_model_set_string(m, "factor_precision", precision), "factor_precision");
    must(context, plm_model_build(m), "build");
    return m;
}

static plm_basis *reduce(plm_context *context, plm_model *model) {
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    must(context, plm_sampler_create(model, &sampler), "sampler");
    must(context, plm_sampler_run(sampler), "sampler");
    must(context, plm_basis_create(model, &basis), "basis");
    must(context, plm_basis_set_sampler(basis, sampler), "basis");
    must(context, plm_basis_build(basis), "basis");
    return basis;
}

static void say_warning(plm_branch *branch) {
    char text[2000] = "";
    if (plm_branch_get_string(branch, "warning", sizeof text, text, NULL) == PLM_OK && text[0])
        fprintf(stderr, "%s\n", text);
}

static void sweep(plm_context *context, plm_basis *basis, int64_t dof) {
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL, *peak = NULL;
    int64_t r = 0, n_points = 0;
    double hz = 0, amplitude = 0;
    must(context, plm_basis_get_int(basis, "size", &r), "size");
    must(context, plm_hbm_create(basis, &hbm), "hbm");
    must(context, plm_hbm_sweep(hbm, &curve), "sweep");
    must(context, plm_branch_get_int(curve, "n_points", &n_points), "n_points");
    must(context, plm_hbm_find_peak(hbm, curve, dof, PLM_PEAK, 0, &hz, &amplitude, &peak), "peak");
    fprintf(stderr, "r = %lld, %lld points, peak %g at %g Hz\n", (long long)r, (long long)n_points, amplitude,
            hz);
    say_warning(curve);
    say_warning(peak);
}

static scene *structure_of(int solid, double dofs, double pairs) {
    cracked_plate_params p = cantilever(solid, dofs, pairs);
    scene *s = NULL;
    p.contact_stiffness = 2e3; /* softer than the bricks' faces: the curve is not what is hard here */
    /* of the first bending in the plane, without crack */
    p.quality_frequency_hz =
        0.1615 * sqrt(p.material.young / p.material.density) * p.width / (p.length * p.length);
    if (cracked_plate_create(&p, &s) != SCENE_OK) exit(1);
    return s;
}

int main(int count, char **argument) {
    stages at = {"", 0, 0};
    plm_context *context = NULL;
    double limit = 0;
    const char *precision = "auto";
    int threads = 1, bad = count < 4;
    for (int i = 4; i < count; i += 2)
        if (i + 1 < count && !strcmp(argument[i], "--threads"))
            threads = atoi(argument[i + 1]);
        else if (i + 1 < count && !strcmp(argument[i], "--limit"))
            limit = atof(argument[i + 1]);
        else if (i + 1 < count && !strcmp(argument[i], "--precision"))
            precision = argument[i + 1];
        else
            bad = 1;
    if (bad || (strcmp(argument[1], "solid") && strcmp(argument[1], "plate"))) {
        fprintf(stderr, "usage: bench_stages solid|plate DOFS PAIRS [--threads N] [--limit MIB] "
                        "[--precision auto|double|single]\n");
        return 2;
    }
    scene *s = structure_of(!strcmp(argument[1], "solid"), atof(argument[2]), atof(argument[3]));
    printf("%lld free DOFs, %lld pairs\n\n| stage | wall s | processor s | MiB at most |\n|--|--:|--:|--:|\n",
           (long long)(s->n_dof - s->n_fixed), (long long)s->n_pairs);
    must(NULL, plm_context_create(PLM_API_VERSION, &context), "context");
    must(context, plm_context_set_threads(context, threads), "threads");
    plm_context_set_progress(context, on_progress, &at);
    plm_context_set_log(context, on_log, NULL);
    const double wall = seconds_of(CLOCK_MONOTONIC), processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    enter(&at, "matrices");
    plm_basis *basis = reduce(context, build(context, s, limit, precision));
    sweep(context, basis, s->output_dof);
    enter(&at, "end");
    printf("| in all | %.1f | %.1f | |\n", seconds_of(CLOCK_MONOTONIC) - wall,
           seconds_of(CLOCK_PROCESS_CPUTIME_ID) - processor);
    plm_context_destroy(&context);
    scene_destroy(&s);
    return 0;
}
