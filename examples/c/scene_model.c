#include "scene_model.h"
#include <stdio.h>
#include <stdlib.h>

void must(plm_context *ctx, plm_status status, const char *what) {
    char text[1024] = "";
    if (status == PLM_OK) return;
    if (status < 0) {
        plm_context_get_error_text(ctx, (int64_t)sizeof text, text, NULL);
        fprintf(stderr, "%s: %s\n", what, text);
        exit(1);
    }
    plm_status_text(status, (int64_t)sizeof text, text, NULL);
    fprintf(stderr, "%s: %s\n", what, text);
}

static plm_status add_pairs(plm_model *model, const scene *s) {
    if (s->n_pairs > 0 && s->dof_b[0] == SCENE_NO_DOF)
        return plm_model_add_ground_contacts_i64(model, 0, s->n_pairs, s->dof_a, s->normal,
                                                 s->contact_stiffness, s->gap);
    return plm_model_add_node_pairs_i64(model, 0, s->n_pairs, s->dof_a, s->dof_b, s->normal,
                                        s->contact_stiffness, s->gap);
}

plm_status scene_to_unbuilt_model(plm_context *ctx, const scene *s, plm_model **model) {
    plm_model *m = NULL;
    plm_status status = plm_model_create(ctx, s->n_dof, &m);
    if (!status)
        status = plm_model_set_matrix_i64(m, PLM_MASS, PLM_CSC, PLM_FULL, 0, PLM_BORROW, s->nnz, s->col_ptr,
                                          s->row, s->m);
    if (!status)
        status = plm_model_set_matrix_i64(m, PLM_STIFFNESS, PLM_CSC, PLM_FULL, 0, PLM_BORROW, s->nnz,
                                          s->col_ptr, s->row, s->k);
    if (!status) status = plm_model_fix_dofs_i64(m, 0, s->n_fixed, s->fixed);
    if (!status) status = add_pairs(m, s);
    if (!status) status = plm_model_set_rayleigh_damping(m, s->mass_damping, s->stiffness_damping);
    if (!status && s->preload) status = plm_model_set_preload(m, s->n_dof, s->preload);
    if (!status) status = plm_model_set_excitation(m, 1, s->n_dof, s->force, NULL);
    if (status < 0) plm_model_destroy(&m);
    *model = m;
    return status;
}

plm_status scene_to_model(plm_context *ctx, const scene *s, plm_model **model) {
    plm_status status = scene_to_unbuilt_model(ctx, s, model);
    if (!status) status = plm_model_build(*model);
    if (status < 0) plm_model_destroy(model);
    return status;
}
