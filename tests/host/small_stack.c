/* A thread with 256 KiB of stack, what README.md asks for, does a whole run and the modes of a larger model.
 */
#define _POSIX_C_SOURCE 200809L
#include "check_host.h"
#include "lattice.h"
#include "whole_run.h"
#include <pthread.h>

enum { STACK = 256 * 1024 };

static void *work(void *user) {
    plm_status *status = (plm_status *)user;
    plm_context *ctx = NULL;
    outcome o;
    double hz[3];
    status[0] = plm_context_create(PLM_API_VERSION, &ctx);
    if (status[0] >= 0) status[0] = whole_run(ctx, CURVE, &o);
    if (status[0] >= 0) status[1] = lattice_modes(ctx, 7, hz);
    plm_context_destroy(&ctx);
    return NULL;
}

int main(void) {
    plm_status status[2] = {PLM_ERR_INTERNAL, PLM_ERR_INTERNAL};
    pthread_attr_t attributes;
    pthread_t thread;
    pthread_attr_init(&attributes);
    EXPECT(pthread_attr_setstacksize(&attributes, STACK) == 0);
    EXPECT(pthread_create(&thread, &attributes, work, status) == 0);
    EXPECT(pthread_join(thread, NULL) == 0);
    pthread_attr_destroy(&attributes);
    EXPECT(status[0] >= 0 && status[1] == PLM_OK);
    return wrong();
}
