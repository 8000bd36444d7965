/* chain.h: a clamped chain of masses with three DOFs per node, as a host would hold it (base 0, compressed
 * columns). Along x the nodes are joined by springs; along y and z each one hangs on its own spring. */
#ifndef CHAIN_H
#define CHAIN_H

#include "plm/plm.h"

enum { CHAIN_NODES = 8, CHAIN_DOFS = 3 * CHAIN_NODES, CHAIN_NNZ_FULL = CHAIN_DOFS + 2 * (CHAIN_NODES - 1) };

typedef struct chain {
    /* full storage, one pattern for both */
    int64_t col_ptr[CHAIN_DOFS + 1], row[CHAIN_NNZ_FULL];
    int32_t col_ptr32[CHAIN_DOFS + 1], row32[CHAIN_NNZ_FULL];
    double m[CHAIN_NNZ_FULL], k[CHAIN_NNZ_FULL];
    double preload[CHAIN_DOFS], force[CHAIN_DOFS];
} chain;

void chain_fill(chain *c);

/* Model with matrices, damping, two contact pairs (nodes 2 and 5 along x; node 7 against ground) and
 * excitation along x at node 4; not built. *model is NULL on failure. */
plm_status chain_model(plm_context *ctx, const chain *c, int with_preload, plm_model **model);

/* The same built. */
plm_status chain_built(plm_context *ctx, int with_preload, plm_model **model);

#endif
