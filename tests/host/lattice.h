/* lattice.h: a clamped block of masses joined by springs along edges and diagonals, large enough that the
 * factorization and the modes take their way for large models. */
#ifndef LATTICE_H
#define LATTICE_H

#include "plm/plm.h"

/* side^3 masses, three DOFs each; the face x = 0 is clamped, one pair against ground at the opposite corner.
 * Built. */
plm_status lattice_built(plm_context *ctx, int side, plm_model **model);

/* The same, and its lowest three frequencies with the pair open; the model is destroyed again. */
plm_status lattice_modes(plm_context *ctx, int side, double *hz);

#endif
