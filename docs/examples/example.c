#include "example.h"
#include <stdio.h>

plm_status start_model(plm_context *ctx, plm_model **model) {
    const int32_t row[] = {0, 1, 1}, column[] = {0, 0, 1}, row_ptr[] = {0, 1}, dof[] = {1};
    const double mass[] = {1, 0, 1}, stiffness[] = {20000, -10000, 10000}, force[] = {0, 1};
    const double coefficient[] = {1}, stop[] = {5000};
    plm_status s = plm_model_create(ctx, 2, model);
    if (!s)
        s = plm_model_set_matrix_i32(*model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, row, column,
                                     mass);
    if (!s)
        s = plm_model_set_matrix_i32(*model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, row,
                                     column, stiffness);
    if (!s) s = plm_model_set_rayleigh_damping(*model, 0, 2e-4);
    if (!s) s = plm_model_add_gap_rows_i32(*model, 0, 1, row_ptr, dof, coefficient, stop, NULL);
    if (!s) s = plm_model_set_excitation(*model, 1, 2, force, NULL);
    return s;
}

plm_status basis_of(plm_model *model, plm_basis **basis) {
    plm_sampler *sampler = NULL;
    plm_status s = plm_sampler_create(model, &sampler);
    if (s >= 0) s = plm_sampler_run(sampler);
    if (s >= 0) s = plm_basis_create(model, basis);
    if (s >= 0) s = plm_basis_set_sampler(*basis, sampler);
    return s < 0 ? s : plm_basis_build(*basis);
}

plm_status start_basis(plm_context *ctx, plm_basis **basis) {
    plm_model *model = NULL;
    plm_status s = start_model(ctx, &model);
    if (!s) s = plm_model_build(model);
    return s < 0 ? s : basis_of(model, basis);
}

int main(void) {
    plm_context *ctx = NULL;
    char text[512] = "";
    int line = 1;
    if (plm_context_create(PLM_API_VERSION, &ctx)) return 1;
    line = example(ctx);
    if (line) plm_context_get_error_text(ctx, sizeof text, text, NULL);
    if (line) printf("line %d went wrong. %s\n", line, text);
    return plm_context_destroy(&ctx) || line;
}
