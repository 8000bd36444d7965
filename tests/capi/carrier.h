/* carrier.h: a pre-loaded oscillator that opens at large amplitude and carries a light second one, about
 * three times as fast. With damping 0.004 its response at force scale 0.006 has an isolated branch. */
#ifndef CARRIER_H
#define CARRIER_H

#include "plm/plm.h"

/* K with the contact closed, as it is at rest; the masses are 1 and 0.2 */
#define CARRIER_K_00 4.048
#define CARRIER_K_01 (-2.048)
#define CARRIER_K_11 2.048

/* Built model with C = damping K, and its basis of kind "full". */
plm_status carrier_built(plm_context *ctx, double damping, plm_model **model, plm_basis **basis);

#endif
