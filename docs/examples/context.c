/* context.c: a context, its callbacks, and what it knows about a failure. */
#include "example.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* [plm_context_create_with_allocator] */
static void *allocate(int64_t bytes, void *user) {
    ++*(int64_t *)user; /* blocks in use */
    return malloc((size_t)bytes);
}
static void release(void *block, void *user) {
    --*(int64_t *)user;
    free(block);
}
static int own_memory(void) {
    int64_t blocks = 0;
    plm_context *ctx = NULL;
    TRY(plm_context_create_with_allocator(PLM_API_VERSION, allocate, release, &blocks, &ctx));
    TRY(plm_context_destroy(&ctx));
    return blocks == 0 ? 0 : __LINE__;
}
/* [plm_context_create_with_allocator] */

/* [plm_context_set_log] */
static void on_log(plm_context *ctx, int32_t level, const char *text, void *user) {
    (void)ctx;
    if (level >= 1) fprintf((FILE *)user, "libplm: %s\n", text);
}
static int with_log(plm_context *ctx) {
    TRY(plm_context_set_log(ctx, on_log, stdout));
    return 0;
}
/* [plm_context_set_log] */

/* [plm_context_set_progress] */
static int32_t on_progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    (void)ctx;
    printf("%s %.0f %%\n", stage, 100 * fraction);
    return *(const int *)user; /* not 0: stop, the call returns PLM_CANCELLED */
}
static int with_progress(plm_context *ctx) {
    static int stop_wanted = 0;
    TRY(plm_context_set_progress(ctx, on_progress, &stop_wanted));
    return 0;
}
/* [plm_context_set_progress] */

/* [plm_context_set_solver] */
/* A solver for small matrices: dense Gaussian elimination without pivots, done anew for every solution. */
typedef struct {
    int64_t n;
    double *a; /* n x n */
} dense;

static int32_t factor(plm_context *ctx, int64_t n, const int64_t *col_ptr, const int64_t *row,
                      const double *value, int32_t positive_definite, void **factor_out, void *user) {
    dense *d = malloc(sizeof *d);
    (void)ctx, (void)positive_definite, (void)user;
    if (!d) return 1;
    d->n = n, d->a = calloc((size_t)(n * n), sizeof *d->a);
    for (int64_t j = 0; d->a && j < n; j++)
        for (int64_t p = col_ptr[j]; p < col_ptr[j + 1]; p++)
            d->a[row[p] + n * j] = d->a[j + n * row[p]] = value[p];
    *factor_out = d;
    return d->a ? 0 : 1;
}
static int32_t solve_one(const dense *d, double *x, double *a) {
    const int64_t n = d->n;
    memcpy(a, d->a, (size_t)(n * n) * sizeof *a);
    for (int64_t k = 0; k < n; k++) {
        if (a[k + n * k] == 0) return 2;
        for (int64_t i = k + 1; i < n; i++) {
            const double f = a[i + n * k] / a[k + n * k];
            for (int64_t j = k; j < n; j++) a[i + n * j] -= f * a[k + n * j];
            x[i] -= f * x[k];
        }
    }
    for (int64_t k = n; k-- > 0;) {
        for (int64_t j = k + 1; j < n; j++) x[k] -= a[k + n * j] * x[j];
        x[k] /= a[k + n * k];
    }
    return 0;
}
static int32_t solve(plm_context *ctx, void *factor_in, int64_t nrhs, double *x, int64_t ldx, void *user) {
    const dense *d = factor_in;
    double *work = malloc((size_t)(d->n * d->n) * sizeof *work);
    int32_t code = work ? 0 : 1;
    (void)ctx, (void)user;
    for (int64_t j = 0; !code && j < nrhs; j++) code = solve_one(d, x + j * ldx, work);
    free(work);
    return code; /* not 0: the call returns PLM_ERR_CALLBACK with this library_code */
}
static void free_factor(plm_context *ctx, void *factor_in, void *user) {
    dense *d = factor_in;
    (void)ctx, (void)user;
    free(d->a);
    free(d);
}
static int with_solver(plm_context *ctx) {
    TRY(plm_context_set_solver(ctx, factor, solve, free_factor, NULL));
    return 0;
}
/* [plm_context_set_solver] */

/* [plm_context_set_inertia] */
/* The negative pivots of the same elimination: as many as the matrix has negative eigenvalues (Sylvester). */
static int32_t inertia(plm_context *ctx, void *factor_in, int64_t *negative, void *user) {
    const dense *d = factor_in;
    const int64_t n = d->n;
    double *a = malloc((size_t)(n * n) * sizeof *a);
    (void)ctx, (void)user;
    if (!a) return 1;
    memcpy(a, d->a, (size_t)(n * n) * sizeof *a);
    *negative = 0;
    for (int64_t k = 0; k < n && *negative >= 0; k++) {
        if (a[k + n * k] == 0) { /* an elimination without pivots that broke down cannot tell */
            *negative = -1;
            break;
        }
        *negative += a[k + n * k] < 0;
        for (int64_t i = k + 1; i < n; i++) {
            const double f = a[i + n * k] / a[k + n * k];
            for (int64_t j = k; j < n; j++) a[i + n * j] -= f * a[k + n * j];
        }
    }
    free(a);
    return 0;
}
static int with_inertia(plm_context *ctx) {
    TRY(plm_context_set_solver(ctx, factor, solve, free_factor, NULL));
    TRY(plm_context_set_inertia(ctx, inertia));
    return 0;
}
/* [plm_context_set_inertia] */

static int run(plm_context *ctx) {
    plm_basis *basis = NULL;
    /* [plm_context_set_threads] */
    TRY(plm_context_set_threads(ctx, 2)); /* faster, with the same digits */
    /* [plm_context_set_threads] */
    /* [plm_context_set_effort] */
    TRY(plm_context_set_effort(
        ctx, 60)); /* a minute of one core for each search; what it has by then is its answer */
    /* [plm_context_set_effort] */
    TRY(start_basis(ctx, &basis));
    return 0;
}

static int failure(plm_context *ctx) {
    /* [plm_context_get_error_text] [plm_context_get_error_function] [plm_context_get_error_argument] */
    /* [plm_context_get_error_info] */
    const int32_t dof[] = {0, 7};
    char text[200], function[64], argument[64];
    plm_status status;
    int32_t reason;
    int64_t index, code;
    plm_model *model = NULL;
    TRY(plm_model_create(ctx, 2, &model));
    if (plm_model_fix_dofs_i32(model, 0, 2, dof) < 0) { /* there is no DOF 7 */
        TRY(plm_context_get_error_text(ctx, sizeof text, text, NULL));
        TRY(plm_context_get_error_function(ctx, sizeof function, function, NULL));
        TRY(plm_context_get_error_argument(ctx, sizeof argument, argument, NULL));
        TRY(plm_context_get_error_info(ctx, &status, &reason, &index, &code));
        printf("%s\n", text);
        printf("%s refuses %s[%d]\n", function, argument, (int)index);
    }
    /* [plm_context_get_error_info] */
    /* [plm_context_get_error_text] [plm_context_get_error_function] [plm_context_get_error_argument] */
    EXPECT(strcmp(argument, "dof") == 0 && index == 1 && status < 0);
    return 0;
}

static int life(void) {
    /* [plm_context_create] [plm_context_destroy] */
    plm_context *ctx = NULL;
    if (plm_context_create(PLM_API_VERSION, &ctx))
        return 1; /* no memory, or not the library of this header */
    /* ... models, bases, curves ... */
    TRY(plm_context_destroy(&ctx)); /* with all that was made in it; ctx is NULL now */
    /* [plm_context_create] [plm_context_destroy] */
    return ctx ? __LINE__ : 0;
}

int example(plm_context *ctx) {
    int line = life();
    if (!line) line = own_memory();
    if (!line) line = with_log(ctx);
    if (!line) line = with_progress(ctx);
    if (!line) line = with_solver(ctx);
    if (!line) line = with_inertia(ctx);
    if (!line) line = run(ctx);
    return line ? line : failure(ctx);
}
