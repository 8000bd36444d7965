/* consumer.c: the smallest host. Two masses on two springs, M = I, K = [2 -1; -1 1]: lambda = (3 -+ sqrt 5)
 * / 2. */
#include <math.h>
#include <plm/plm.h>
#include <stdio.h>

static int solve(plm_context *ctx, double *frequency_hz) {
    const int32_t diagonal[] = {0, 1}, row[] = {0, 1, 1}, column[] = {0, 0, 1};
    const double mass[] = {1, 1}, stiffness[] = {2, -1, 1};
    plm_model *model = NULL;
    int64_t n_free = 0;
    return plm_model_create(ctx, 2, &model) ||
           plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 2, diagonal,
                                    diagonal, mass) ||
           plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, row,
                                    column, stiffness) ||
           plm_model_build(model) || plm_model_get_int(model, "n_free", &n_free) || n_free != 2 ||
           plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 2, frequency_hz, NULL);
}

int main(void) {
    const double two_pi = 6.28318530717958647692;
    double frequency_hz[2] = {0, 0};
    char text[512] = "";
    plm_context *ctx = NULL;
    int bad = plm_context_create(PLM_API_VERSION, &ctx) || solve(ctx, frequency_hz);
    if (bad) plm_context_get_error_text(ctx, sizeof text, text, NULL);
    for (int i = 0; i < 2 && !bad; i++) {
        const double expected = sqrt((3 + (i ? 1 : -1) * sqrt(5.0)) / 2) / two_pi;
        if (!(fabs(frequency_hz[i] / expected - 1) < 1e-10)) bad = 1;
    }
    printf("%s: %.12g Hz, %.12g Hz %s\n", bad ? "wrong" : "right", frequency_hz[0], frequency_hz[1], text);
    return plm_context_destroy(&ctx) || bad;
}
