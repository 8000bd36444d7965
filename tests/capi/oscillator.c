#include "oscillator.h"
#include <math.h>
#include <stddef.h>

plm_status oscillator_built(plm_context *ctx, const oscillator *o, double highest_hz, plm_model **model,
                            plm_basis **basis) {
    static const int64_t ptr[] = {0, 1}, row[] = {0}, dof[] = {0};
    static const double one[] = {1};
    plm_status s = plm_model_create(ctx, 1, model);
    if (!s) s = plm_model_set_matrix_i64(*model, PLM_MASS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 1, ptr, row, one);
    if (!s)
        s = plm_model_set_matrix_i64(*model, PLM_STIFFNESS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 1, ptr, row,
                                     &o->k);
    if (!s) s = plm_model_set_rayleigh_damping(*model, o->c, 0);
    if (!s && o->k_n > 0) s = plm_model_add_gap_rows_i64(*model, 0, 1, ptr, dof, one, &o->k_n, &o->gap);
    if (!s) s = plm_model_set_excitation(*model, 1, 1, &o->force, NULL);
    if (!s) s = plm_model_build(*model);
    if (!basis || s) return s;
    s = plm_basis_create(*model, basis);
    if (!s) s = plm_basis_set_string(*basis, "kind", "full");
    if (!s) s = plm_basis_set_double(*basis, "frequency_min_hz", 0.01 * highest_hz);
    if (!s) s = plm_basis_set_double(*basis, "frequency_max_hz", highest_hz);
    if (!s) s = plm_basis_build(*basis);
    return s;
}

void oscillator_motion(const oscillator *o, double omega, double q_0, double v_0, double t, double *q,
                       double *v) {
    const double a = o->k - omega * omega, b = o->c * omega, size = a * a + b * b;
    const double c = o->force * a / size, s = o->force * b / size; /* the periodic part c cos + s sin */
    const double decay = 0.5 * o->c, free = sqrt(o->k - decay * decay), e = exp(-decay * t);
    const double x = q_0 - c, y = (v_0 - omega * s + decay * x) / free;
    const double cf = cos(free * t), sf = sin(free * t), co = cos(omega * t), so = sin(omega * t);
    *q = c * co + s * so + e * (x * cf + y * sf);
    *v = omega * (s * co - c * so) + e * (-decay * (x * cf + y * sf) + free * (y * cf - x * sf));
}
