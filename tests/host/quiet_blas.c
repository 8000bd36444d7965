/* What a self-contained library's own OpenBLAS does to its host: nothing runs beside the calling thread while
 * libplm works. The processor time of the process is that of its calling thread. */
#define _POSIX_C_SOURCE 200809L
#include "check_host.h"
#include "whole_run.h"
#include <time.h>

static double seconds(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(void) {
    const struct timespec moment = {1, 0};
    outcome o;
    plm_context *ctx = NULL;
    double process, thread;
    int k;
    EXPECT(plm_context_create(PLM_API_VERSION, &ctx) == PLM_OK);
    nanosleep(&moment, NULL); /* threads that were made at loading time go to sleep */
    process = seconds(CLOCK_PROCESS_CPUTIME_ID), thread = seconds(CLOCK_THREAD_CPUTIME_ID);
    for (k = 0; k < 3; ++k) EXPECT(whole_run(ctx, CURVE, &o) >= 0);
    process = seconds(CLOCK_PROCESS_CPUTIME_ID) - process;
    thread = seconds(CLOCK_THREAD_CPUTIME_ID) - thread;
    printf("%.4f s of the calling thread, %.4f s of the process\n", thread, process);
    EXPECT(process < 1.1 * thread + 0.01);
    EXPECT(plm_context_destroy(&ctx) == PLM_OK);
    return wrong();
}
