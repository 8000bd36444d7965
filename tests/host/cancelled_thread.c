/* A host ends its worker by pthread_cancel while the library computes, and its progress callback is a
 * cancellation point, as every printf is: the call under way is finished, the thread ends, the context serves
 * another one. */
#define _POSIX_C_SOURCE 200809L
#include "check_host.h"
#include "whole_run.h"
#include <pthread.h>
#include <semaphore.h>
#include <string.h>

typedef struct {
    plm_context *ctx;
    sem_t computing;
    int calls, in_callback;
    outcome o;
} worker;

static int32_t on_progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    worker *w = (worker *)user;
    (void)ctx, (void)stage, (void)fraction;
    w->in_callback = 1;
    if (++w->calls == 40) sem_post(&w->computing);
    pthread_testcancel();
    w->in_callback = 0;
    return 0;
}

/* No cancellation point of its own: it ends between two calls. */
static void *work(void *user) {
    worker *w = (worker *)user;
    for (;;) whole_run(w->ctx, CURVE, &w->o);
    return NULL;
}

/* A thread that has switched cancellation off finds it off after any call. */
static int state_stays(plm_context *ctx, int want) {
    int before, after;
    pthread_setcancelstate(want, &before);
    plm_context_set_threads(ctx, 1);
    pthread_setcancelstate(before, &after);
    return after == want;
}

int main(void) {
    worker w;
    outcome want, got;
    pthread_t thread;
    void *result = NULL;
    memset(&w, 0, sizeof w);
    EXPECT(sem_init(&w.computing, 0, 0) == 0);
    EXPECT(plm_context_create(PLM_API_VERSION, &w.ctx) == PLM_OK);
    EXPECT(whole_run(w.ctx, CURVE, &want) >= 0);
    EXPECT(plm_context_set_progress(w.ctx, on_progress, &w) == PLM_OK);
    EXPECT(pthread_create(&thread, NULL, work, &w) == 0);
    sem_wait(&w.computing);
    EXPECT(pthread_cancel(thread) == 0);
    EXPECT(pthread_join(thread, &result) == 0 && result == PTHREAD_CANCELED);
    EXPECT(w.calls >= 40 && !w.in_callback);
    EXPECT(plm_context_set_progress(w.ctx, NULL, NULL) == PLM_OK);
    EXPECT(whole_run(w.ctx, CURVE, &got) >= 0 && memcmp(&want, &got, sizeof want) == 0);
    EXPECT(state_stays(w.ctx, PTHREAD_CANCEL_DISABLE) && state_stays(w.ctx, PTHREAD_CANCEL_ENABLE));
    EXPECT(plm_context_destroy(&w.ctx) == PLM_OK);
    sem_destroy(&w.computing);
    return wrong();
}
