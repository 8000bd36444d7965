#include "carrier.h"
#include <stddef.h>

plm_status carrier_built(plm_context *ctx, double damping, plm_model **model, plm_basis **basis) {
    static const int64_t row[] = {0, 1, 1}, column[] = {0, 0, 1}, ptr[] = {0, 1}, dof[] = {0};
    static const double mass[] = {1, 0, 0.2}, one[] = {1}, force[] = {1, 0}, preload[] = {0.5, 0};
    static const double stiffness[] = {CARRIER_K_00 - 1, CARRIER_K_01, CARRIER_K_11};
    plm_status s = plm_model_create(ctx, 2, model);
    if (!s)
        s = plm_model_set_matrix_i64(*model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, row, column,
                                     mass);
    if (!s)
        s = plm_model_set_matrix_i64(*model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 3, row,
                                     column, stiffness);
    if (!s) s = plm_model_set_rayleigh_damping(*model, 0, damping);
    if (!s) s = plm_model_add_gap_rows_i64(*model, 0, 1, ptr, dof, one, one, NULL);
    if (!s) s = plm_model_set_preload(*model, 2, preload);
    if (!s) s = plm_model_set_excitation(*model, 1, 2, force, NULL);
    if (!s) s = plm_model_build(*model);
    if (!s) s = plm_basis_create(*model, basis);
    if (!s) s = plm_basis_set_string(*basis, "kind", "full");
    if (!s) s = plm_basis_set_double(*basis, "frequency_min_hz", 0.14);
    if (!s) s = plm_basis_set_double(*basis, "frequency_max_hz", 0.26);
    if (!s) s = plm_basis_build(*basis);
    return s;
}
