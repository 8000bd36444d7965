/* brick.h: the 8-node brick with incompatible modes, isotropic linear elasticity. */
#ifndef BRICK_H
#define BRICK_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct brick_material {
    double young;   /* > 0 */
    double poisson; /* > -1 and < 0.5 */
    double density; /* > 0 */
} brick_material;

/* SCENE_OK, or SCENE_ERR_ARGUMENT when a constant is out of range (or NaN). */
int brick_material_check(const brick_material *material);

/*
 * Stiffness and consistent mass of one brick.
 *   xyz  24 coordinates, node-major; nodes 0-3 turn anticlockwise seen from nodes 4-7, which stand above them
 *   k    24 x 24, symmetric to the last bit; DOF = 3 node + component
 *   m    8 x 8: the mass between two nodes, the same for each of the three directions; symmetric to the last
 * bit Returns SCENE_OK, or SCENE_ERR_ELEMENT when the Jacobian is not positive at a Gauss point. Source:
 * Taylor, Beresford, Wilson, "A non-conforming element for stress analysis", IJNME 10 (1976) 1211-1219.
 */
int brick_matrices(const double xyz[24], const brick_material *material, double k[24 * 24], double m[8 * 8]);

#ifdef __cplusplus
}
#endif

#endif
