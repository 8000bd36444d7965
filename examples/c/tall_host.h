/* tall_host.h: a host that keeps all that is tall itself: the tall operations on dense matrices of its own,
 * with its own elimination, in plain C. */
#ifndef TALL_HOST_H
#define TALL_HOST_H

#include "plm/plm.h"

enum { TALL_OPERATIONS = PLM_TALL_DIAGONAL + 1, TALL_MOST_THINGS = 4096 };

typedef struct tall_thing {
    int64_t handle, cols;
    double *value; /* n x cols; of a factor n x n */
    char *held;    /* [n], of a factor; NULL: it is a block */
} tall_thing;

typedef struct tall_host {
    int64_t n;
    const double *m, *k, *c; /* n x n each, column-major; c NULL: none */
    const char *held;        /* [n] DOFs that stand still, or NULL */
    plm_context *ctx;        /* that every call must name */
    int64_t fail_at;         /* the call that fails with TALL_FAILURE, counted from 1; 0: none */
    int says_nothing;        /* RESPONSES and counts are answered by "cannot" */
    double told[16];         /* what FACTS says in place of what is so, where told[0] != 0 */
    int64_t calls, of[TALL_OPERATIONS], ends, wrong; /* wrong: calls that break the contract */
    int64_t n_things;
    tall_thing thing[TALL_MOST_THINGS];
} tall_host;

#define TALL_FAILURE 77

int32_t tall_operation(plm_context *ctx, int32_t operation, const int64_t *number, const double *factor,
                       const double *small_in, double *small_out, void *user);

/* What the library has not given back, for a host whose model never came to its end. */
void tall_host_clear(tall_host *h);

#endif
