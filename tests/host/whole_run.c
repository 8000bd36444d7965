#include "whole_run.h"
#include "chain.h"
#include <string.h>

enum { WATCHED = 12 /* node 4, x */ };

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        const plm_status status_ = (call);                                                                   \
        if (status_ < 0 || status_ == PLM_CANCELLED) return status_;                                         \
    } while (0)

static plm_status read_branch(plm_branch *branch, outcome *o) {
    double q[CHAIN_DOFS], u[16], share[2], coefficient[3 * 21], residual;
    int32_t closed[16];
    int64_t n;
    TRY(plm_branch_get_field(branch, 0, 0.3, CHAIN_DOFS, q));
    TRY(plm_branch_get_contact(branch, 0, 8, u, NULL, closed));
    TRY(plm_branch_get_closed_share(branch, 0, 2, share));
    TRY(plm_branch_get_coefficients(branch, 0, WATCHED, 3, coefficient));
    TRY(plm_branch_get_full_residual(branch, 0, &residual));
    return plm_branch_get_amplitude(branch, WATCHED, PLM_PEAK, 0, 1, &o->amplitude, &n);
}

plm_status whole_run(plm_context *ctx, run_size size, outcome *o) {
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *full = NULL, *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL, *one = NULL;
    double q[CHAIN_DOFS], shape[3 * CHAIN_DOFS], residual;
    int64_t n;
    memset(o, 0, sizeof *o);
    TRY(chain_built(ctx, 1, &model));
    TRY(plm_model_audit(model, &n));
    TRY(plm_model_solve_rest(model));
    TRY(plm_model_get_array(model, "rest_displacement", CHAIN_DOFS, q, &n));
    TRY(plm_model_get_modes(model, PLM_SYSTEM_SLIDING, NULL, 3, o->hz, shape));
    TRY(plm_sampler_create(model, &sampler));
    TRY(plm_sampler_set_int(sampler, "n_harmonics",
                            5)); /* those of the curve: the whole run is run hundreds of times */
    if (size == SMALL) TRY(plm_sampler_set_int(sampler, "n_samples", 3));
    TRY(plm_sampler_run(sampler));
    TRY(plm_sampler_get_double(sampler, "blf_hz", &o->blf_hz));
    TRY(plm_basis_create(model, &full));
    TRY(plm_basis_set_string(full, "kind", "full"));
    TRY(plm_basis_set_sampler(full, sampler));
    TRY(plm_basis_build(full));
    TRY(plm_basis_create(model, &basis));
    TRY(plm_basis_set_sampler(basis, sampler));
    if (size == CURVE) TRY(plm_basis_set_parent(basis, full));
    TRY(plm_basis_build(basis));
    TRY(plm_basis_get_residual(basis, 0, 1, CHAIN_DOFS, shape, &residual));
    TRY(plm_hbm_create(basis, &hbm));
    TRY(plm_hbm_set_int(hbm, "n_harmonics", size == SMALL ? 1 : 5));
    TRY(plm_hbm_set_int(hbm, "max_points", size == SMALL ? 2 : 1000));
    TRY(plm_hbm_sweep(hbm, &curve));
    TRY(plm_branch_get_int(curve, "n_points", &o->points));
    TRY(plm_hbm_find_peak(hbm, curve, WATCHED, PLM_PEAK, 0, &o->peak_hz, &o->peak_amplitude, NULL));
    TRY(plm_hbm_solve(hbm, size == SMALL ? 1.0 : o->blf_hz, size == SMALL ? NULL : curve, 0, &one));
    return read_branch(one, o);
}
