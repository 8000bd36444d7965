/* A host whose BLAS has 64-bit integers under the usual names. A library that shares its BLAS says so at once
 * instead of computing nonsense; a self-contained one does not care, and never calls it. */
#include "check_host.h"
#include "lattice.h"
#include "whole_run.h"

static int called;

double ddot_(const int64_t *n, const double *x, const int64_t *step_x, const double *y,
             const int64_t *step_y);
double ddot_(const int64_t *n, const double *x, const int64_t *step_x, const double *y,
             const int64_t *step_y) {
    double sum = 0;
    int64_t k;
    ++called;
    for (k = 0; k < *n; ++k) sum += x[k * *step_x] * y[k * *step_y];
    return sum;
}

/* reference LAPACK's answer to such a call: it reads 32 bits of garbage with each integer, prints and stops
 */
#define STOPS(name)                                                                                          \
    void name(void);                                                                                         \
    void name(void) {                                                                                        \
        ++called;                                                                                            \
    }
STOPS(dpotrf_)
STOPS(dgemm_)
STOPS(dtrsm_)
STOPS(dsyrk_)
STOPS(dsyevd_)

int main(void) {
    plm_context *ctx = NULL;
    const plm_status s = plm_context_create(PLM_API_VERSION, &ctx);
#ifdef PLM_SELF_CONTAINED
    outcome o;
    double hz[3] = {0, 0, 0};
    EXPECT(s == PLM_OK);
    EXPECT(whole_run(ctx, CURVE, &o) >= 0 && lattice_modes(ctx, 6, hz) == PLM_OK && called == 0);
    EXPECT(plm_context_destroy(&ctx) == PLM_OK);
#else
    EXPECT(s == PLM_ERR_NOT_BUILT && ctx == NULL && called == 1);
#endif
    return wrong();
}
