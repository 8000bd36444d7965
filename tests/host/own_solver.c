/* A host that brings its own factorization: model, rest, sampler, bases, sweep, peak and residuals go by its
 * callbacks alone. The built-in CHOLMOD is not even started, and both find the same response. */
#include "chain.h"
#include "check_host.h"
#include "whole_run.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* CHOLMOD's first call, seen on its way (the linker leads it here: --wrap); all that it allocates or factors
 * comes after it. */
static int cholmod_starts;
#ifdef PLM_WITH_CHOLMOD
int WRAPPED(void *common);
int ORIGINAL(void *common);
int WRAPPED(void *common) {
    ++cholmod_starts;
    return ORIGINAL(common);
}
#endif

/* the host's solver: dense LU with partial pivoting, as it must also serve indefinite matrices */
typedef struct {
    int factors, solves, alive, definite, indefinite;
} counts;
typedef struct {
    int64_t n, pivot[CHAIN_DOFS];
    double a[CHAIN_DOFS * CHAIN_DOFS];
} dense;

static void swap_rows(double *x, int64_t ld, int64_t columns, int64_t i, int64_t j) {
    int64_t k;
    for (k = 0; k < columns; ++k) {
        const double t = x[i + ld * k];
        x[i + ld * k] = x[j + ld * k], x[j + ld * k] = t;
    }
}

static int32_t eliminate(dense *d) {
    const int64_t n = d->n;
    int64_t i, j, k;
    for (k = 0; k < n; ++k) {
        int64_t p = k;
        for (i = k + 1; i < n; ++i)
            if (fabs(d->a[i + n * k]) > fabs(d->a[p + n * k])) p = i;
        if (d->a[p + n * k] == 0) return 7;
        d->pivot[k] = p;
        swap_rows(d->a, n, n, k, p);
        for (i = k + 1; i < n; ++i) {
            const double f = d->a[i + n * k] /= d->a[k + n * k];
            for (j = k + 1; j < n; ++j) d->a[i + n * j] -= f * d->a[k + n * j];
        }
    }
    return 0;
}

static int32_t factor(plm_context *ctx, int64_t n, const int64_t *col_ptr, const int64_t *row,
                      const double *value, int32_t positive_definite, void **out, void *user) {
    counts *c = (counts *)user;
    dense *d = n <= CHAIN_DOFS ? (dense *)calloc(1, sizeof *d) : NULL;
    int64_t j, p;
    (void)ctx;
    if (!d) return 1;
    d->n = n;
    for (j = 0; j < n; ++j)
        for (p = col_ptr[j]; p < col_ptr[j + 1]; ++p) d->a[row[p] + n * j] = d->a[j + n * row[p]] = value[p];
    if (eliminate(d)) {
        free(d);
        return 7;
    }
    ++c->factors, ++c->alive, ++*(positive_definite ? &c->definite : &c->indefinite);
    *out = d;
    return 0;
}

static int32_t solve(plm_context *ctx, void *handle, int64_t nrhs, double *x, int64_t ldx, void *user) {
    const dense *d = (const dense *)handle;
    const int64_t n = d->n;
    int64_t i, j, k;
    (void)ctx;
    ++((counts *)user)->solves;
    for (j = 0; j < nrhs; ++j) {
        double *b = x + j * ldx;
        for (k = 0; k < n; ++k) swap_rows(b, n, 1, k, d->pivot[k]);
        for (k = 0; k < n; ++k)
            for (i = k + 1; i < n; ++i) b[i] -= d->a[i + n * k] * b[k];
        for (k = n; k-- > 0;) {
            for (i = k + 1; i < n; ++i) b[k] -= d->a[k + n * i] * b[i];
            b[k] /= d->a[k + n * k];
        }
    }
    return 0;
}

static void release(plm_context *ctx, void *handle, void *user) {
    (void)ctx;
    --((counts *)user)->alive;
    free(handle);
}

static plm_status run(counts *own, outcome *o) {
    plm_context *ctx = NULL;
    char text[512] = "";
    plm_status s = plm_context_create(PLM_API_VERSION, &ctx);
    if (!s && own) s = plm_context_set_solver(ctx, factor, solve, release, own);
    if (!s) s = whole_run(ctx, CURVE, o);
    if (s) plm_context_get_error_text(ctx, sizeof text, text, NULL);
    if (s) printf("status %d: %s\n", (int)s, text);
    EXPECT(plm_context_destroy(&ctx) == PLM_OK);
    return s;
}

static int close_to(double a, double b) {
    return fabs(a - b) <= 1e-8 * fabs(b);
}

int main(void) {
    counts c;
    outcome own, built_in;
    memset(&c, 0, sizeof c);
    EXPECT(run(&c, &own) == PLM_OK);
    EXPECT(cholmod_starts == 0);
    EXPECT(c.factors > 0 && c.solves > c.factors && c.alive == 0);
    printf(
        "own solver: %d factorizations (%d of indefinite matrices), %d solutions, CHOLMOD started %d times\n",
        c.factors, c.indefinite, c.solves, cholmod_starts);

    EXPECT(run(NULL, &built_in) == PLM_OK);
#ifdef PLM_WITH_CHOLMOD
    EXPECT(cholmod_starts > 0); /* or the count above means nothing */
#endif
    printf("built-in:   CHOLMOD started %d times; peaks %.12g and %.12g at %.12g and %.12g Hz\n",
           cholmod_starts, own.peak_amplitude, built_in.peak_amplitude, own.peak_hz, built_in.peak_hz);
    EXPECT(own.points > 10 && close_to(own.hz[2], built_in.hz[2]) && close_to(own.blf_hz, built_in.blf_hz));
    EXPECT(close_to(own.peak_hz, built_in.peak_hz) && close_to(own.peak_amplitude, built_in.peak_amplitude));
    return wrong();
}
