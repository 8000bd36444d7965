/* bilinear_oscillator.h: one mass on a spring beside a one-sided elastic stop; the smallest scene, with
 * closed forms. */
#ifndef BILINEAR_OSCILLATOR_H
#define BILINEAR_OSCILLATOR_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * m x" + c x' + k x + k_c max(x - gap, 0) = force cos(omega t) + preload, in any consistent units.
 * With gap = preload = 0 the frequency is 2 w1 w2 / (w1 + w2), w1 = sqrt(k/m), w2 = sqrt((k + k_c)/m), at any
 * amplitude.
 */
typedef struct bilinear_oscillator_params {
    double mass;              /* > 0 */
    double stiffness;         /* k >= 0 */
    double damping;           /* c >= 0 */
    double contact_stiffness; /* k_c of the stop; negative = let the library choose */
    double gap;               /* between mass and stop at rest; negative = interference */
    double force;
    int with_preload;
    double preload; /* static force, positive presses the mass against the stop */
} bilinear_oscillator_params;

/* m = k = 1, k_c = 3 (w2 = 2 w1, bilinear frequency 4/3), c = 0.02, unit force; pre-load 0.5. There is one
 * size. */
void bilinear_oscillator_default(bilinear_oscillator_params *params);

/*
 * One node, three DOFs: x moves, y and z are clamped (with the same m and k, so that no matrix is singular).
 * SCENE_OK and a new scene, or SCENE_ERR_ARGUMENT, SCENE_ERR_MEMORY.
 */
int bilinear_oscillator_create(const bilinear_oscillator_params *params, scene **out);

#ifdef __cplusplus
}
#endif

#endif
