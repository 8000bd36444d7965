/* calls.h: every function of plm.h as a call on a handle (made by calls.py). */
#ifndef CALLS_H
#define CALLS_H

#include "plm/plm.h"

enum {
    KIND_CONTEXT,
    KIND_MODEL,
    KIND_SAMPLER,
    KIND_BASIS,
    KIND_HBM,
    KIND_BRANCH,
    KIND_TRANSIENT,
    KIND_STUDY,
    N_KINDS
};
enum { TAKES, DESTROYS /* its argument is the address of a handle */, FREE /* no handle */ };

typedef struct {
    const char *name;
    int kind, how;
    plm_status (*call)(void *handle);                /* all else 0 or NULL */
    plm_status (*second)(void *handle, void *other); /* with a second handle among the arguments, or NULL */
} api_call;

extern const api_call api_calls[];
extern const int n_api_calls;

#endif
