/* whole_run.h: everything a host does with the library, on the chain of tests/capi: model, rest, modes,
 * sampler, bases, sweep, peak, one solution, fields. */
#ifndef WHOLE_RUN_H
#define WHOLE_RUN_H

#include "plm/plm.h"

typedef struct {
    double hz[3], blf_hz, peak_hz, peak_amplitude, amplitude;
    int64_t points;
} outcome;

/* SMALL: three points with one harmonic */
typedef enum { SMALL, CURVE } run_size;

/* The first failure (< 0) or cancellation is returned, and `o` is then incomplete. */
plm_status whole_run(plm_context *ctx, run_size size, outcome *o);

#endif
