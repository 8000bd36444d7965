/* A host that traps floating-point exceptions: the full run raises none in its hands, and the traps are still
 * set when its own code runs (callbacks, after the call). */
#define _GNU_SOURCE
#include "check_host.h"
#include "whole_run.h"
#include <fenv.h>
#include <string.h>

#define TRAPS (FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW)

static int calls, unset;

static int32_t on_progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    (void)ctx, (void)stage, (void)fraction, (void)user;
    ++calls;
    unset += fegetexcept() != TRAPS;
    return 0;
}

int main(void) {
    outcome plain, trapped;
    plm_context *ctx = NULL;
    EXPECT(plm_context_create(PLM_API_VERSION, &ctx) == PLM_OK);
    EXPECT(plm_context_set_progress(ctx, on_progress, NULL) == PLM_OK);
    unset = 0;
    EXPECT(whole_run(ctx, CURVE, &plain) >= 0);
    calls = unset = 0;
    feenableexcept(TRAPS);
    EXPECT(whole_run(ctx, CURVE, &trapped) >= 0);
    EXPECT(fegetexcept() == TRAPS);
    EXPECT(plm_context_destroy(&ctx) == PLM_OK);
    EXPECT(fegetexcept() == TRAPS);
    fedisableexcept(FE_ALL_EXCEPT);
    EXPECT(calls > 0 && unset == 0);
    EXPECT(memcmp(&plain, &trapped, sizeof plain) == 0);
    printf("%d callbacks, all with the traps of the host\n", calls);
    return wrong();
}
