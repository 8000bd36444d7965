/* A host whose BLAS has 64-bit integers under the usual names. A library that shares its BLAS says so at once
 * instead of computing nonsense; a self-contained one does not care. */
#include "check_host.h"
#include "plm/plm.h"

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

int main(void) {
    plm_context *ctx = NULL;
    const plm_status s = plm_context_create(PLM_API_VERSION, &ctx);
#ifdef PLM_SELF_CONTAINED
    EXPECT(s == PLM_OK && called == 0);
    EXPECT(plm_context_destroy(&ctx) == PLM_OK);
#else
    EXPECT(s == PLM_ERR_NOT_BUILT && ctx == NULL && called == 1);
#endif
    return wrong();
}
