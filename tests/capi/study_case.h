/* study_case.h: what the tests of plm_study share: an oscillator with a stop, its handles, and readings by
 * key. */
#ifndef STUDY_CASE_H
#define STUDY_CASE_H

#include "check.h"
#include "oscillator.h"

typedef struct study_case {
    plm_model *model;
    plm_basis *basis; /* kind "full" */
    plm_hbm *hbm;     /* 0.12 to 0.2 Hz around the resonance at 1 rad/s, seven harmonics */
    plm_study *study; /* of the oscillator's displacement, one repeat */
} study_case;

/* m = k = 1, 2 % damping, a stop of stiffness 0.3 at a distance of 5 from rest; unit force. */
plm_status study_case_make(plm_context *ctx, study_case *c);
/* The same with the stop at another distance. */
plm_status study_case_with_gap(plm_context *ctx, double gap, study_case *c);

/* one entry of an array result; NaN when it cannot be read */
double study_real(plm_study *study, const char *key, int64_t index);
/* -99 when it cannot be read */
int64_t study_int(plm_study *study, const char *key, int64_t index);
/* a result that is one number */
double study_scalar(plm_study *study, const char *key);

#endif
