/* minimal.c: two masses on springs, one of them beside a stop; the peak of the response near the first
 * resonance. */
#include <plm/plm.h>
#include <stdio.h>

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if ((call) < 0) return 1;                                                                            \
    } while (0)

static int find_peak(plm_context *ctx, double *hz, double *amplitude) {
    /* kg, N, m, s. M = diag(1, 1), K = [20000 -10000; -10000 10000], lower triangles by triplets, base 0 */
    const int32_t diagonal[] = {0, 1}, row[] = {0, 1, 1}, column[] = {0, 0, 1};
    const double mass[] = {1, 1}, stiffness[] = {20000, -10000, 10000};
    const double force[] = {0, 1}; /* 1 N cos(omega t) on mass 1 */
    /* the stop: u = q_1 - gap > 0 is closed, pushes back with 5000 N/m */
    const int32_t row_start[] = {0, 1}, stop_dof[] = {1};
    const double coefficient[] = {1}, stop_stiffness[] = {5000}, gap[] = {0};
    plm_model *model = NULL;

    TRY(plm_model_create(ctx, 2, &model));
    TRY(plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 2, diagonal, diagonal,
                                 mass));
    TRY(plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, row, column,
                                 stiffness));
    TRY(plm_model_set_rayleigh_damping(model, 0, 2e-4));
    TRY(plm_model_add_gap_rows_i32(model, 0, 1, row_start, stop_dof, coefficient, stop_stiffness, gap));
    TRY(plm_model_set_excitation(model, 1, 2, force, NULL));
    TRY(plm_model_build(model));

    /* nothing is set: basis, harmonics and range follow from the accuracy */
    TRY(plm_model_compute_response(model, 1, PLM_HALF_PEAK_TO_PEAK, 1e-3, hz, amplitude, NULL, NULL, NULL));
    return 0;
}

int main(void) {
    double hz = 0, amplitude = 0;
    char text[512] = "";
    plm_context *ctx = NULL;
    TRY(plm_context_create(PLM_API_VERSION, &ctx));
    const int failed = find_peak(ctx, &hz, &amplitude);
    plm_context_get_error_text(ctx, sizeof text, text, NULL);
    if (*text) fprintf(stderr, "%s\n", text); /* what failed, or what should be looked at */
    if (!failed) printf("peak: %.4f mm at %.3f Hz\n", 1e3 * amplitude, hz);
    plm_context_destroy(&ctx); /* and everything made in it */
    return failed;
}
