/* coaxial_cylinders.h: two thin cylinders, one pushed a little way into the other (paper, section 3.1). */
#ifndef COAXIAL_CYLINDERS_H
#define COAXIAL_CYLINDERS_H

#include <stdint.h>

#include "brick.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where a cylinder's two extra supports hold, besides its clamped end. */
typedef struct cylinder_support {
    int32_t ring; /* in rings of bricks from the clamped end, 1 .. n_along; 0 = no extra support */
    int radial;   /* != 0: the radial motion of the two places is held */
    int axial;    /* != 0: the motion along the axis is held */
} cylinder_support;

/*
 * The axis is z. The inner cylinder is clamped at z = 0, the outer one at its far end; the inner one's outer
 * surface touches the outer one's inner surface over overlap_rings rings of bricks, node on node. The
 * supports, at the angles 0 and pi, break the axial symmetry: bending along x meets them, bending along y
 * does not. Lengths in mm, forces in N, E in MPa, density in t/mm3.
 */
typedef struct coaxial_cylinders_params {
    double contact_radius; /* where they touch: outside of the inner, inside of the outer cylinder */
    double wall;           /* thickness of each wall */
    double length;         /* of each cylinder */
    int32_t n_around;      /* bricks around, a multiple of 4 */
    int32_t n_along;       /* bricks along each cylinder */
    int32_t n_wall;        /* bricks through each wall */
    int32_t overlap_rings; /* 0 .. n_along: n_around (overlap_rings + 1) pairs */
    cylinder_support support;
    brick_material material;
    double gap;               /* initial gap of every pair, mm; the meshes touch all the same */
    double contact_stiffness; /* N/mm per pair; negative = let the library choose */
    double force; /* harmonic force in N along y, on the outer cylinder's free edge at the angle pi/2 */
    double quality_factor; /* Q = 1 / (beta omega) at quality_frequency_hz; 0 = no damping */
    double quality_frequency_hz;
    int with_preload;
    double radial_preload; /* N, outwards on every contact node of the inner cylinder */
} coaxial_cylinders_params;

/* The paper's cylinders: 64 x 60 x 2 bricks each, 23,424 nodes, 256 pairs. */
void coaxial_cylinders_paper(coaxial_cylinders_params *params);

/* The same on 16 x 12 x 1 bricks each, 32 pairs. */
void coaxial_cylinders_quick(coaxial_cylinders_params *params);

/* SCENE_OK and a new scene, or SCENE_ERR_ARGUMENT, SCENE_ERR_MEMORY. */
int coaxial_cylinders_create(const coaxial_cylinders_params *params, scene **out);

#ifdef __cplusplus
}
#endif

#endif
