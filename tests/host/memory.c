/* The k-th allocation fails, for every k of a full run: PLM_ERR_MEMORY, the same context then does the whole
 * run with the results it has always had, and nothing is left when it is destroyed. */
#include "check_host.h"
#include "whole_run.h"
#include <stdlib.h>
#include <string.h>

typedef struct {
    int64_t live, total, fail_at;
} counter;

static void *allocate(int64_t bytes, void *user) {
    counter *c = (counter *)user;
    void *block = ++c->total == c->fail_at ? NULL : malloc((size_t)bytes);
    c->live += block != NULL;
    return block;
}
static void release(void *block, void *user) {
    --((counter *)user)->live;
    free(block);
}

/* With argument: every STEP-th allocation only (for valgrind). */
int main(int argc, char **argv) {
    counter c = {0, 0, 0};
    outcome want, got;
    plm_context *ctx = NULL;
    int64_t k, total, step = argc > 1 ? atol(argv[1]) : 1, tried = 0;
    plm_context_create_with_allocator(PLM_API_VERSION, allocate, release, &c, &ctx);
    EXPECT(whole_run(ctx, SMALL, &want) >= 0);
    plm_context_destroy(&ctx);
    total = c.total;
    EXPECT(total > 100 && c.live == 0);
    for (k = 1; k <= total && !wrong_count; k += step, ++tried) {
        plm_status status;
        c.total = 0, c.fail_at = k;
        status = plm_context_create_with_allocator(PLM_API_VERSION, allocate, release, &c, &ctx);
        if (status == PLM_OK) status = whole_run(ctx, SMALL, &got);
        EXPECT(status == PLM_ERR_MEMORY);
        if (status != PLM_ERR_MEMORY)
            printf("allocation %ld of %ld: status %d\n", (long)k, (long)total, (int)status);
        c.fail_at = 0;
        if (ctx && tried % 16 == 0) { /* still usable */
            EXPECT(whole_run(ctx, SMALL, &got) >= 0);
            EXPECT(memcmp(&want, &got, sizeof want) == 0);
        }
        plm_context_destroy(&ctx);
        EXPECT(c.live == 0);
        if (wrong_count)
            printf("allocation %ld of %ld: %ld blocks left\n", (long)k, (long)total, (long)c.live);
    }
    printf("%ld of %ld allocations failed in turn\n", (long)tried, (long)total);
    return wrong();
}
