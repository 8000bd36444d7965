/* cracked_plate.h: a cantilever plate with an edge crack that opens and closes (paper, section 3.2). */
#ifndef CRACKED_PLATE_H
#define CRACKED_PLATE_H

#include <stdint.h>

#include "brick.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { CRACKED_PLATE_LOADS = 4 };

/*
 * The plate fills 0 <= x <= length, 0 <= y <= width, 0 <= z <= thickness and is clamped at x = 0. The crack
 * starts from the top edge y = width in the plane x = crack_position and is crack_rows rows of bricks deep;
 * its nodes are doubled, one contact pair each (the front of the crack stays joined). Lengths in mm, forces
 * in N, E in MPa, density in t/mm3.
 *
 * In-plane bending is mode 4 of the open system with the default crack, and the scene says so whatever the
 * parameters; nearer to the clamp it moves down (a quarter of the length, 7 of 13 rows: mode 3).
 */
typedef struct cracked_plate_params {
    double length, width, thickness;
    int32_t nx, ny, nz;           /* bricks along x, y, z */
    double crack_position;        /* x of the crack, between 0 and length */
    int32_t columns_before_crack; /* bricks between clamp and crack, 1 .. nx - 1; 0 = as even as can be */
    int32_t crack_rows;           /* 1 .. ny - 1 */
    int32_t further_cracks;       /* alike; with them crack_position does not count: all are evenly along x */
    brick_material material;
    double gap;               /* initial gap of every pair, mm; negative = interference */
    double contact_stiffness; /* N/mm per pair; negative = let the library choose */
    double force;             /* harmonic force in N along y, at the tip's middle node */
    double quality_factor;    /* Q = 1 / (beta omega) at quality_frequency_hz; 0 = no damping */
    double quality_frequency_hz;

    /*
     * Static pre-load, used when with_preload != 0. Without a gap, which pairs are closed at rest depends on
     * where and in which direction the loads act, not on their common size. Positions do not follow
     * crack_position.
     */
    int with_preload;
    int32_t n_loads; /* 0 .. CRACKED_PLATE_LOADS: line loads across the top edge y = width */
    double load_x[CRACKED_PLATE_LOADS]; /* where; between nodes a load is shared between its two neighbours */
    double load_fx[CRACKED_PLATE_LOADS]; /* total force along x, N */
    double load_fy[CRACKED_PLATE_LOADS]; /* total force along y, N; negative presses on the plate */
    double end_compression; /* N, even pressure along -x on the face x = length: closes the whole crack */
} cracked_plate_params;

/* The paper's plate: 33 x 35 x 4 bricks, 18,630 DOFs, crack at mid length, 18 of 35 rows deep, 90 pairs. */
void cracked_plate_paper(cracked_plate_params *params);

/* One with an isolated branch between 1,250 and 2,100 Hz at a force scale of 0.3: 24 x 13 x 1 bricks, the
 * crack at a quarter of the length, 7 of 13 rows deep, closed at rest by an even pressure on its end, Q =
 * 500. */
void cracked_plate_isolated(cracked_plate_params *params);

/* The paper's plate on 12 x 10 x 2 bricks, 15 pairs. */
void cracked_plate_quick(cracked_plate_params *params);

/* SCENE_OK and a new scene, or SCENE_ERR_ARGUMENT, SCENE_ERR_MEMORY. */
int cracked_plate_create(const cracked_plate_params *params, scene **out);

#ifdef __cplusplus
}
#endif

#endif
