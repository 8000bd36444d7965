/* scene.c: life and death of a scene, and the arrays that every scene has. */
#include "scene.h"

#include <stdlib.h>
#include <string.h>

#include "scene_build.h"

scene *scene_new(const char *name) {
    scene *s = calloc(1, sizeof *s);
    if (s) strncpy(s->name, name, sizeof s->name - 1);
    return s;
}

int scene_allocate(scene *s, int64_t n_fixed, int64_t n_pairs, int with_preload) {
    s->fixed = calloc((size_t)(n_fixed + 1), sizeof *s->fixed); /* + 1: calloc(0) may return NULL */
    s->dof_a = calloc((size_t)(3 * n_pairs + 1), sizeof *s->dof_a);
    s->dof_b = calloc((size_t)(3 * n_pairs + 1), sizeof *s->dof_b);
    s->normal = calloc((size_t)(3 * n_pairs + 1), sizeof *s->normal);
    s->gap = calloc((size_t)(n_pairs + 1), sizeof *s->gap);
    s->contact_stiffness = calloc((size_t)(n_pairs + 1), sizeof *s->contact_stiffness);
    s->force = calloc((size_t)s->n_dof, sizeof *s->force);
    if (with_preload) s->preload = calloc((size_t)s->n_dof, sizeof *s->preload);
    if (!s->fixed || !s->dof_a || !s->dof_b || !s->normal || !s->gap || !s->contact_stiffness || !s->force ||
        (with_preload && !s->preload))
        return SCENE_ERR_MEMORY;
    s->n_fixed = n_fixed;
    s->n_pairs = n_pairs;
    return SCENE_OK;
}

void scene_set_pair(scene *s, int64_t pair, int64_t node_a, int64_t node_b, const double normal[3],
                    double gap, double contact_stiffness) {
    for (int c = 0; c < 3; c++) {
        s->dof_a[3 * pair + c] = 3 * node_a + c;
        s->dof_b[3 * pair + c] = node_b < 0 ? SCENE_NO_DOF : 3 * node_b + c;
        s->normal[3 * pair + c] = normal[c];
    }
    s->gap[pair] = gap;
    s->contact_stiffness[pair] = contact_stiffness;
}

void scene_destroy(scene **handle) {
    if (!handle || !*handle) return;
    scene *s = *handle;
    free(s->xyz);
    free(s->col_ptr);
    free(s->row);
    free(s->m);
    free(s->k);
    free(s->fixed);
    free(s->dof_a);
    free(s->dof_b);
    free(s->normal);
    free(s->gap);
    free(s->contact_stiffness);
    free(s->preload);
    free(s->force);
    free(s);
    *handle = NULL;
}

const char *scene_error_text(int code) {
    switch (code) {
    case SCENE_OK:
        return "no error";
    case SCENE_ERR_ARGUMENT:
        return "an argument is NULL or out of its range";
    case SCENE_ERR_NAME:
        return "there is no scene of this name";
    case SCENE_ERR_SIZE:
        return "the size must be \"paper\" or \"quick\"";
    case SCENE_ERR_MEMORY:
        return "out of memory";
    case SCENE_ERR_ELEMENT:
        return "an element is turned inside out or has no volume";
    default:
        return "unknown code";
    }
}
