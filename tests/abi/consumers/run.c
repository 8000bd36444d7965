/* run.c: a host of the first version in C89: the way from matrices to the peak of a response, with every
 * callback. */
#include <plm/plm.h>
#include <stdio.h>
#include <stdlib.h>

static int64_t blocks;
static int calls_of_progress, calls_of_log;

static void *allocate(int64_t bytes, void *user) {
    ++*(int64_t *)user;
    return malloc((size_t)bytes);
}
static void release(void *block, void *user) {
    --*(int64_t *)user;
    free(block);
}
static void on_log(plm_context *ctx, int32_t level, const char *text, void *user) {
    (void)ctx, (void)user;
    calls_of_log += level >= 0 && text[0] != 0;
}
static int32_t on_progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    (void)ctx, (void)user;
    calls_of_progress += stage[0] != 0 && fraction >= 0 && fraction <= 1;
    return 0;
}

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if ((call) < 0) return __LINE__;                                                                     \
    } while (0)

static int peak(plm_context *ctx, double *hz, double *amplitude) {
    static const int32_t diagonal[] = {0, 1}, row[] = {0, 1, 1}, column[] = {0, 0, 1}, start[] = {0, 1},
                         dof[] = {1};
    static const double mass[] = {1, 1}, stiffness[] = {20000, -10000, 10000}, force[] = {0, 1}, one[] = {1},
                        stop[] = {5000}, gap[] = {0};
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL;
    double share[1], u[8], q[2];
    int32_t closed[8];
    int64_t points = 0;
    TRY(plm_model_create(ctx, 2, &model));
    TRY(plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 2, diagonal, diagonal,
                                 mass));
    TRY(plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, row, column,
                                 stiffness));
    TRY(plm_model_set_rayleigh_damping(model, 0, 2e-4));
    TRY(plm_model_add_gap_rows_i32(model, 0, 1, start, dof, one, stop, gap));
    TRY(plm_model_set_excitation(model, 1, 2, force, NULL));
    TRY(plm_model_build(model));
    TRY(plm_sampler_create(model, &sampler));
    TRY(plm_sampler_set_int(sampler, "mode", 1));
    TRY(plm_sampler_run(sampler));
    TRY(plm_basis_create(model, &basis));
    TRY(plm_basis_set_sampler(basis, sampler));
    TRY(plm_basis_build(basis));
    TRY(plm_hbm_create(basis, &hbm));
    TRY(plm_hbm_sweep(hbm, &curve));
    TRY(plm_hbm_find_peak(hbm, curve, 1, PLM_HALF_PEAK_TO_PEAK, 0, hz, amplitude, NULL));
    TRY(plm_branch_get_int(curve, "n_points", &points));
    TRY(plm_branch_get_field(curve, 0, 0.25, 2, q));
    TRY(plm_branch_get_contact(curve, 0, 8, u, NULL, closed));
    TRY(plm_branch_get_closed_share(curve, 0, 1, share));
    return points > 3 && share[0] > 0 && share[0] < 1 ? 0 : __LINE__;
}

int main(void) {
    double hz = 0, amplitude = 0;
    plm_context *ctx = NULL;
    char text[512] = "";
    int failed = plm_context_create_with_allocator(PLM_API_VERSION, allocate, release, &blocks, &ctx);
    if (!failed)
        failed = plm_context_set_log(ctx, on_log, NULL) || plm_context_set_progress(ctx, on_progress, NULL);
    if (!failed) failed = peak(ctx, &hz, &amplitude);
    if (failed) plm_context_get_error_text(ctx, sizeof text, text, NULL);
    failed |= plm_context_destroy(&ctx) != 0 || blocks != 0 || calls_of_progress == 0 || calls_of_log == 0;
    /* the peak as the first version found it */
    failed |= !(hz > 11.364 && hz < 11.367 && amplitude > 0.010878 && amplitude < 0.010882);
    printf("%s: %.6g at %.6g Hz, progress %d, log %d, blocks left %d %s\n", failed ? "wrong" : "right",
           amplitude, hz, calls_of_progress, calls_of_log, (int)blocks, text);
    return failed;
}
