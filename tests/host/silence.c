/* How long the host hears nothing: the longest time of the processor between two progress calls (or a call's
 * begin or end), over a run of everything on a plate, and in the calls that can take long on a small model.
 * And a request to stop is obeyed where that is. A single factorization, eigenvalue problem or solve of an
 * external library cannot be interrupted: on the plate all of them are short. */
#define _POSIX_C_SOURCE 199309L
#include "check_host.h"
#include "plm/plm.h"
#include "scene_model.h"
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* 0.5 s is promised; another half for a processor whose caches are shared with other programs. argv[1]:
 * slowness of an instrumented build. */
static double allowed = 1.0;

typedef struct {
    double heard, longest, stop_after, began;
    char now[64], stage[64], worst[224];
    int stopped;
} ear;

static double processor_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void hear(ear *e, const char *stage) {
    const double now = processor_seconds();
    if (now - e->heard > e->longest) {
        e->longest = now - e->heard;
        snprintf(e->worst, sizeof e->worst, "%s, between %s and %.63s", e->now, e->stage, stage);
    }
    e->heard = now;
    snprintf(e->stage, sizeof e->stage, "%s", stage);
}

static int32_t on_progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    ear *e = (ear *)user;
    (void)ctx, (void)fraction;
    hear(e, stage);
    if (e->stop_after <= 0 || e->heard - e->began < e->stop_after) return 0;
    e->stopped = 1;
    return 1;
}

static void begin(ear *e, const char *what) {
    snprintf(e->now, sizeof e->now, "%s", what);
    strcpy(e->stage, "its begin");
    e->heard = e->began = processor_seconds(), e->stopped = 0;
}
static plm_status end(ear *e, plm_status status) {
    hear(e, "its end");
    return status;
}
#define HEARD(call) (begin(e, #call), end(e, call))
#define DONE(call) EXPECT(HEARD(call) >= 0)

static void look_at(ear *e, plm_hbm *hbm, plm_branch *curve, int64_t dof) {
    double value, hz, amplitude, errors[3], shifts[3], real[2000], imag[2000];
    int64_t n;
    DONE(plm_hbm_find_peak(hbm, curve, dof, PLM_HALF_PEAK_TO_PEAK, 0, &hz, &amplitude, NULL));
    DONE(plm_hbm_estimate_error(hbm, curve, 0, dof, PLM_HALF_PEAK_TO_PEAK, 0, errors, shifts));
    DONE(plm_branch_get_full_residual(curve, 0, &value));
    DONE(plm_branch_get_periodicity_defect(curve, 0, &value));
    DONE(plm_branch_get_multipliers(curve, 0, 2000, real, imag, &n));
}

static void in_time(ear *e, plm_model *model, plm_basis *basis, plm_branch *curve) {
    plm_transient *marching = NULL, *exact = NULL;
    DONE(plm_transient_create(model, NULL, &marching));
    DONE(plm_transient_set_int(marching, "periods", 2));
    DONE(plm_transient_set_int(marching, "steps_per_period", 64));
    DONE(plm_transient_start_at(marching, curve, 0));
    DONE(plm_transient_run(marching));
    DONE(plm_transient_create(model, basis, &exact));
    DONE(plm_transient_start_at(exact, curve, 0));
    DONE(plm_transient_run(exact));
    DONE(plm_transient_find_periodic(exact));
}

static void everything_on_a_plate(ear *e, plm_context *ctx) {
    scene *s = NULL;
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL, *full = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL, *mode = NULL;
    double hz[6];
    int64_t n;
    EXPECT(scene_create("cracked_plate", "quick", 1, &s) == 0);
    if (!s) return;
    EXPECT(scene_to_model(ctx, s, &model) >= 0);
    DONE(plm_model_audit(model, &n));
    DONE(plm_model_solve_rest(model));
    DONE(plm_model_get_modes(model, PLM_SYSTEM_SLIDING, NULL, 6, hz, NULL));
    DONE(plm_sampler_create(model, &sampler));
    DONE(plm_sampler_run(sampler));
    DONE(plm_basis_create(model, &basis));
    DONE(plm_basis_set_sampler(basis, sampler));
    DONE(plm_basis_build(basis));
    DONE(plm_basis_create(model, &full));
    DONE(plm_basis_set_string(full, "kind", "craig_bampton"));
    DONE(plm_basis_set_sampler(full, sampler));
    DONE(plm_basis_build(full));
    DONE(plm_hbm_create(basis, &hbm));
    DONE(plm_hbm_set_int(hbm, "n_harmonics", 5));
    DONE(plm_hbm_set_string(hbm, "stability", "floquet"));
    DONE(plm_hbm_sweep(hbm, &curve));
    if (curve) look_at(e, hbm, curve, s->output_dof);
    if (curve) in_time(e, model, basis, curve);
    DONE(plm_hbm_find_nonlinear_mode(hbm, s->dominant_mode, s->output_dof, 0, &mode));
    scene_destroy(&s);
}

/* Two masses and a stop between them. */
static plm_hbm *two_masses(plm_context *ctx, double light, int64_t harmonics, plm_model **made) {
    static const int64_t ptr[] = {0, 2, 4}, row[] = {0, 1, 0, 1}, gap_ptr[] = {0, 2}, i[] = {0, 1};
    static const double k[] = {2e4, -1e4, -1e4, 1e4}, coefficient[] = {1, -1}, k_n = 3e4, gap = 1e-5,
                        f[] = {0, 10};
    double m[2] = {1, 1};
    plm_model *model = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    m[1] = light;
    EXPECT(plm_model_create(ctx, 2, &model) == PLM_OK);
    EXPECT(plm_model_set_matrix_i64(model, PLM_STIFFNESS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 4, ptr, row, k) ==
           PLM_OK);
    EXPECT(plm_model_set_matrix_i64(model, PLM_MASS, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, 2, i, i, m) ==
           PLM_OK);
    EXPECT(plm_model_set_rayleigh_damping(model, 2, 0) == PLM_OK);
    EXPECT(plm_model_add_gap_rows_i64(model, 0, 1, gap_ptr, row, coefficient, &k_n, &gap) == PLM_OK);
    EXPECT(plm_model_set_excitation(model, 1, 2, f, NULL) == PLM_OK);
    EXPECT(plm_model_build(model) == PLM_OK);
    EXPECT(plm_basis_create(model, &basis) == PLM_OK);
    EXPECT(plm_basis_set_string(basis, "kind", "full") == PLM_OK);
    EXPECT(plm_basis_set_double(basis, "frequency_min_hz", 5) == PLM_OK);
    EXPECT(plm_basis_set_double(basis, "frequency_max_hz", 25) == PLM_OK);
    EXPECT(plm_basis_build(basis) >= 0);
    EXPECT(plm_hbm_create(basis, &hbm) == PLM_OK);
    EXPECT(plm_hbm_set_int(hbm, "n_harmonics", harmonics) == PLM_OK);
    EXPECT(plm_hbm_set_string(hbm, "stability", "off") == PLM_OK);
    *made = model;
    return hbm;
}

/* 4,000 equations with 1000 harmonics: one factorization has 4e10 flops. */
static void many_harmonics_can_be_stopped(ear *e, plm_context *ctx) {
    plm_model *model = NULL;
    plm_hbm *hbm = two_masses(ctx, 0.5, 1000, &model);
    plm_branch *branch = NULL;
    plm_hbm_set_string(hbm, "unknowns", "modal");
    e->stop_after = 0.3 * allowed;
    EXPECT(HEARD(plm_hbm_solve(hbm, 14.0, NULL, 0, &branch)) == PLM_CANCELLED && e->stopped && !branch);
    e->stop_after = 0;
}

/* A light mass that still counts as one, at 1e5 Hz: its modes are known, and no step waits for it. */
static void a_defect_is_quick(ear *e, plm_context *ctx) {
    plm_model *model = NULL;
    plm_hbm *hbm = two_masses(ctx, 3e-8, 3, &model);
    plm_branch *branch = NULL;
    double defect = -1;
    EXPECT(HEARD(plm_hbm_solve(hbm, 7.0, NULL, 0, &branch)) >= 0);
    if (branch) EXPECT(HEARD(plm_branch_get_periodicity_defect(branch, 0, &defect)) >= 0 && defect >= 0);
}

/* What a marched period holds: 64,000 instants, 800 harmonics. */
static void a_long_period_is_heard_of(ear *e, plm_context *ctx) {
    plm_model *model = NULL;
    plm_hbm *hbm = two_masses(ctx, 0.5, 3, &model);
    plm_transient *marching = NULL;
    plm_study *study = NULL;
    int64_t index;
    EXPECT(hbm && plm_transient_create(model, NULL, &marching) == PLM_OK);
    EXPECT(plm_transient_set_int(marching, "periods", 1) == PLM_OK);
    EXPECT(plm_transient_set_int(marching, "period_multiple", 16) == PLM_OK);
    EXPECT(plm_transient_set_int(marching, "steps_per_period", 4000) == PLM_OK);
    EXPECT(plm_study_create(model, &study) == PLM_OK);
    EXPECT(plm_study_set_output(study, 1, PLM_PEAK, 0) == PLM_OK);
    EXPECT(plm_study_set_reference(study, hbm) == PLM_OK);
    EXPECT(plm_study_add_marching(study, "marched", marching, 1, &index) == PLM_OK);
    DONE(plm_study_run(study));
}

int main(int argc, char **argv) {
    ear e;
    plm_context *ctx = NULL;
    memset(&e, 0, sizeof e);
    if (argc > 1) allowed *= atof(argv[1]);
    EXPECT(plm_context_create(PLM_API_VERSION, &ctx) == PLM_OK);
    EXPECT(plm_context_set_progress(ctx, on_progress, &e) == PLM_OK);
    strcpy(e.now, "start"), strcpy(e.stage, "start"), e.heard = processor_seconds();
    everything_on_a_plate(&e, ctx);
    printf("plate: longest silence %.3f s in %s\n", e.longest, e.worst);
    many_harmonics_can_be_stopped(&e, ctx);
    a_defect_is_quick(&e, ctx);
    a_long_period_is_heard_of(&e, ctx);
    printf("longest silence %.3f s in %s\n", e.longest, e.worst);
    EXPECT(e.longest < allowed);
    EXPECT(plm_context_destroy(&ctx) == PLM_OK);
    return wrong();
}
