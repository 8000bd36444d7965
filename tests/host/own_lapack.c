/* A host with its own ARPACK, LAPACK, CHOLMOD and FFTW: here they abort, so that any captured call is seen.
 */
#include "whole_run.h"
#include <stdio.h>
#include <stdlib.h>

#define OWN(name)                                                                                            \
    void name(void);                                                                                         \
    void name(void) {                                                                                        \
        fputs("libplm called the host's own " #name "\n", stderr);                                           \
        abort();                                                                                             \
    }
OWN(dsaupd_)
OWN(dseupd_)
OWN(dsyevr_)
OWN(dsyevd_)
OWN(dsygvd_)
OWN(dgesdd_)
OWN(zgetrf_)
OWN(dpotrf_)
OWN(dgemm_)
OWN(cholmod_l_start)
OWN(cholmod_l_analyze)
OWN(SuiteSparse_malloc)
OWN(GOMP_parallel)
OWN(fftw_execute)

int main(void) {
    outcome o;
    plm_context *ctx = NULL;
    char text[512] = "";
    plm_status s = plm_context_create(PLM_API_VERSION, &ctx);
    if (!s) s = whole_run(ctx, CURVE, &o);
    if (s) plm_context_get_error_text(ctx, sizeof text, text, NULL);
    printf("status %d, %d points, peak %.6g at %.6g Hz %s\n", (int)s, (int)o.points, o.peak_amplitude,
           o.peak_hz, text);
    return plm_context_destroy(&ctx) || s < 0;
}
