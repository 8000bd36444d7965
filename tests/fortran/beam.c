/* beam.c: the beam of examples/fortran from the C scenes' own brick code; prints the numbers that example
 * prints. */
#include "cracked_plate.h"
#include <plm/plm.h>
#include <stdio.h>

#define TRY(call)                                                                                            \
    if ((call) < 0) return 1

static scene *make_scene(void) {
    scene *s = NULL;
    cracked_plate_params p;
    cracked_plate_paper(&p);
    p.length = 200, p.width = 20, p.thickness = 10;
    p.nx = 20, p.ny = 6, p.nz = 2;
    p.crack_position = 40, p.columns_before_crack = 4, p.crack_rows = 3;
    p.material = (brick_material){2.1e5, 0.3, 7.8e-9};
    p.contact_stiffness = PLM_AUTO_STIFFNESS;
    p.force = 10;
    p.quality_factor = 50, p.quality_frequency_hz = 400;
    return cracked_plate_create(&p, &s) ? NULL : s;
}

static int make_model(plm_context *ctx, const scene *s, plm_model **model) {
    TRY(plm_model_create(ctx, s->n_dof, model));
    TRY(plm_model_set_matrix_i64(*model, PLM_MASS, PLM_CSC, PLM_FULL, 0, PLM_COPY, s->nnz, s->col_ptr, s->row,
                                 s->m));
    TRY(plm_model_set_matrix_i64(*model, PLM_STIFFNESS, PLM_CSC, PLM_FULL, 0, PLM_COPY, s->nnz, s->col_ptr,
                                 s->row, s->k));
    TRY(plm_model_set_rayleigh_damping(*model, s->mass_damping, s->stiffness_damping));
    TRY(plm_model_fix_dofs_i64(*model, 0, s->n_fixed, s->fixed));
    TRY(plm_model_add_node_pairs_i64(*model, 0, s->n_pairs, s->dof_a, s->dof_b, s->normal,
                                     s->contact_stiffness, s->gap));
    TRY(plm_model_set_excitation(*model, 1, s->n_dof, s->force, NULL));
    TRY(plm_model_build(*model));
    return 0;
}

static int run(plm_context *ctx, const scene *s) {
    plm_model *model = NULL;
    double open[3], sliding[3], hz = 0, mm = 0;
    if (make_model(ctx, s, &model)) return 1;
    TRY(plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 3, open, NULL));
    TRY(plm_model_get_modes(model, PLM_SYSTEM_SLIDING, NULL, 3, sliding, NULL));
    TRY(plm_model_compute_response(model, s->output_dof, PLM_HALF_PEAK_TO_PEAK, 1e-3, &hz, &mm, NULL, NULL,
                                   NULL));
    printf("open_hz %.9f %.9f %.9f\n", open[0], open[1], open[2]);
    printf("sliding_hz %.9f %.9f %.9f\n", sliding[0], sliding[1], sliding[2]);
    printf("peak_hz %.9f\npeak_mm %.9e\n", hz, mm);
    return 0;
}

int main(void) {
    plm_context *ctx = NULL;
    scene *s = make_scene();
    if (!s || plm_context_create(PLM_API_VERSION, &ctx)) return 1;
    const int failed = run(ctx, s);
    plm_context_destroy(&ctx);
    scene_destroy(&s);
    return failed;
}
