/* Cancelled at the k-th progress callback, for every k of a full run: PLM_CANCELLED, and the same context
 * then does the whole run as if nothing had been. */
#include "check_host.h"
#include "whole_run.h"
#include <stdlib.h>
#include <string.h>

typedef struct {
    int calls, cancel_at;
    char stage[64];
} listener;

static int32_t on_progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    listener *l = (listener *)user;
    (void)ctx, (void)fraction;
    if (++l->calls != l->cancel_at) return 0;
    strncpy(l->stage, stage, sizeof l->stage - 1);
    return 1;
}

/* With argument: every STEP-th callback only. */
int main(int argc, char **argv) {
    listener l;
    outcome want, got;
    plm_context *ctx = NULL;
    int k, total, step = argc > 1 ? atoi(argv[1]) : 1, tried = 0;
    memset(&l, 0, sizeof l);
    EXPECT(plm_context_create(PLM_API_VERSION, &ctx) == PLM_OK);
    EXPECT(plm_context_set_progress(ctx, on_progress, &l) == PLM_OK);
    EXPECT(whole_run(ctx, CURVE, &want) >= 0);
    plm_context_destroy(&ctx);
    total = l.calls;
    EXPECT(total > 20);
    for (k = 1; k <= total; k += step, ++tried) {
        plm_status status;
        plm_context_create(PLM_API_VERSION, &ctx);
        plm_context_set_progress(ctx, on_progress, &l);
        l.calls = 0, l.cancel_at = k;
        status = whole_run(ctx, CURVE, &got);
        EXPECT(status == PLM_CANCELLED && l.calls == k);
        if (status != PLM_CANCELLED || l.calls != k)
            printf("callback %d of %d (%s): status %d, %d callbacks\n", k, total, l.stage, (int)status,
                   l.calls);
        l.cancel_at = 0;
        if (tried % 8 == 0) {
            EXPECT(whole_run(ctx, CURVE, &got) >= 0);
            EXPECT(memcmp(&want, &got, sizeof want) == 0);
        }
        EXPECT(plm_context_destroy(&ctx) == PLM_OK);
    }
    printf("cancelled at %d of %d callbacks in turn\n", tried, total);
    return wrong();
}
