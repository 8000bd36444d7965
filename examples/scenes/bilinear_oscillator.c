/* bilinear_oscillator.c: see bilinear_oscillator.h. */
#include "bilinear_oscillator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene_build.h"

void bilinear_oscillator_default(bilinear_oscillator_params *p) {
    memset(p, 0, sizeof *p);
    p->mass = 1;
    p->stiffness = 1;
    p->damping = 0.02;
    p->contact_stiffness = 3;
    p->force = 1;
    p->preload = 0.5;
}

static int bad_params(const bilinear_oscillator_params *p) {
    return !(p->mass > 0) || !(p->stiffness >= 0) || !(p->damping >= 0) || !isfinite(p->mass) ||
           !isfinite(p->stiffness) || !isfinite(p->damping) || !isfinite(p->contact_stiffness) ||
           !isfinite(p->gap) || !isfinite(p->force) || !isfinite(p->preload);
}

static int diagonal_matrices(const bilinear_oscillator_params *p, scene *s) {
    s->n_nodes = 1;
    s->n_dof = s->nnz = 3;
    s->xyz = calloc(3, sizeof *s->xyz);
    s->col_ptr = calloc(4, sizeof *s->col_ptr);
    s->row = calloc(3, sizeof *s->row);
    s->m = calloc(3, sizeof *s->m);
    s->k = calloc(3, sizeof *s->k);
    if (!s->xyz || !s->col_ptr || !s->row || !s->m || !s->k) return SCENE_ERR_MEMORY;
    for (int i = 0; i < 3; i++) {
        s->row[i] = i;
        s->col_ptr[i + 1] = i + 1;
        s->m[i] = p->mass;
        s->k[i] = p->stiffness;
    }
    return SCENE_OK;
}

static int fill(const bilinear_oscillator_params *p, scene *s) {
    const double along_x[3] = {1, 0, 0};
    int status = diagonal_matrices(p, s);
    if (!status) status = scene_allocate(s, 2, 1, p->with_preload);
    if (status) return status;
    s->fixed[0] = 1;
    s->fixed[1] = 2;
    scene_set_pair(s, 0, 0, -1, along_x, p->gap, p->contact_stiffness);
    s->force[0] = p->force;
    if (p->with_preload) s->preload[0] = p->preload;
    s->output_dof = 0;
    s->mass_damping = p->damping / p->mass;
    s->dominant_system = SCENE_OPEN;
    s->dominant_mode = 1;
    return SCENE_OK;
}

int bilinear_oscillator_create(const bilinear_oscillator_params *p, scene **out) {
    if (!p || !out || bad_params(p)) return SCENE_ERR_ARGUMENT;
    scene *s = scene_new("bilinear_oscillator");
    const int status = s ? fill(p, s) : SCENE_ERR_MEMORY;
    if (status)
        scene_destroy(&s);
    else
        *out = s;
    return status;
}
