/* oscillator.h: one mass 1 on a spring and a damper, with a ground contact at u = q - gap, under a force at
 * one frequency. */
#ifndef OSCILLATOR_H
#define OSCILLATOR_H

#include "plm/plm.h"

typedef struct oscillator {
    double k, c;     /* spring, damper: alpha of Rayleigh's damping */
    double k_n, gap; /* k_n = 0: no contact */
    double force;
} oscillator;

/* Built model, and unless `basis` is NULL its basis of kind "full" for frequencies up to `highest_hz`. */
plm_status oscillator_built(plm_context *ctx, const oscillator *o, double highest_hz, plm_model **model,
                            plm_basis **basis);

/* Closed form without contact: q and v at time t of q'' + c q' + k q = F cos omega t from q_0, v_0; c < 2
 * sqrt k. */
void oscillator_motion(const oscillator *o, double omega, double q_0, double v_0, double t, double *q,
                       double *v);

#endif
