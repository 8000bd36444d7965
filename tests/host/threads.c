/* Two threads with a context each, at once: the results of one alone. Preset tsan runs it under
 * ThreadSanitizer. */
#define _POSIX_C_SOURCE 200809L
#include "check_host.h"
#include "whole_run.h"
#include <pthread.h>
#include <string.h>

enum { ROUNDS = 2 };

typedef struct {
    outcome o;
    plm_status status;
    int rounds;
} thread_data;

static void *work(void *user) {
    thread_data *t = (thread_data *)user;
    int k;
    for (k = 0; k < t->rounds && t->status >= 0; ++k) {
        plm_context *ctx = NULL;
        t->status = plm_context_create(PLM_API_VERSION, &ctx);
        if (t->status >= 0) t->status = whole_run(ctx, CURVE, &t->o);
        plm_context_destroy(&ctx);
    }
    return NULL;
}

int main(void) {
    thread_data alone, together[2];
    pthread_t id[2];
    int k;
    memset(&alone, 0, sizeof alone);
    memset(together, 0, sizeof together);
    alone.rounds = 1, together[0].rounds = together[1].rounds = ROUNDS;
    work(&alone);
    for (k = 0; k < 2; ++k) pthread_create(&id[k], NULL, work, &together[k]);
    for (k = 0; k < 2; ++k) pthread_join(id[k], NULL);
    EXPECT(alone.status >= 0 && alone.o.points > 10);
    for (k = 0; k < 2; ++k) EXPECT(memcmp(&alone.o, &together[k].o, sizeof alone.o) == 0);
    return wrong();
}
