/* assembly.h: a mesh of bricks, and its sparse M and K. */
#ifndef ASSEMBLY_H
#define ASSEMBLY_H

#include <stdint.h>

#include "brick.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct brick_mesh {
    int64_t n_nodes;
    double *xyz; /* 3 n_nodes */
    int64_t n_bricks;
    int64_t *brick; /* 8 n_bricks node numbers, in the order brick_matrices() wants */
} brick_mesh;

/* Allocates the two arrays (zeroed). SCENE_ERR_ARGUMENT for counts below 1 or too large to hold. */
int brick_mesh_create(int64_t n_nodes, int64_t n_bricks, brick_mesh *mesh);
void brick_mesh_free(brick_mesh *mesh);

/*
 * Fills n_nodes, xyz (a copy), n_dof, nnz, col_ptr, row, m and k of a zeroed scene. On failure the scene may
 * be partly filled; scene_destroy() releases it.
 */
int assemble_bricks(const brick_mesh *mesh, const brick_material *material, scene *s);

#ifdef __cplusplus
}
#endif

#endif
