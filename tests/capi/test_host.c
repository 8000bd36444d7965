/* The library as a guest: allocator, log, progress, the host's solver, the floating-point environment,
 * re-entry. */
#define _GNU_SOURCE
#include "chain.h"
#include "check.h"
#include <fenv.h>

/* ---- allocator that counts, and fails on request ---- */
typedef struct {
    int64_t live, total, fail_at; /* fail_at: number of the allocation that fails; 0: none */
} counter;

static void *counting_allocate(int64_t bytes, void *user) {
    counter *c = (counter *)user;
    if (++c->total == c->fail_at) return NULL;
    ++c->live;
    return malloc((size_t)bytes);
}
static void counting_release(void *block, void *user) {
    --((counter *)user)->live;
    free(block);
}

/* model, rest, modes, sampler, basis, one solution; the first failure is returned */
static plm_status whole_run(plm_context *ctx) {
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *branch = NULL;
    double hz[3];
    plm_status s = chain_built(ctx, 1, &model);
    if (!s) s = plm_model_solve_rest(model);
    if (!s) s = plm_model_get_modes(model, PLM_SYSTEM_SLIDING, NULL, 3, hz, NULL);
    if (!s) s = plm_sampler_create(model, &sampler);
    if (!s) s = plm_sampler_run(sampler);
    if (!s) s = plm_basis_create(model, &basis);
    if (!s) s = plm_basis_set_sampler(basis, sampler);
    if (!s) s = plm_basis_build(basis);
    if (s > 0) s = 0;
    if (!s) s = plm_hbm_create(basis, &hbm);
    if (!s) s = plm_hbm_solve(hbm, 1.0, NULL, 0, &branch);
    return s;
}

static void all_memory_comes_back(void **state) {
    counter c = {0, 0, 0};
    plm_context *ctx = NULL;
    int k;
    (void)state;
    for (k = 0; k < 2; ++k) {
        assert_int_equal(
            plm_context_create_with_allocator(PLM_API_VERSION, counting_allocate, counting_release, &c, &ctx),
            PLM_OK);
        assert_true(done(ctx, whole_run(ctx)));
        assert_true(c.total > 100 && c.live > 10);
        assert_int_equal(plm_context_destroy(&ctx), PLM_OK);
        assert_int_equal(c.live, 0);
    }
}

static void memory_comes_back_after_any_failure(void **state) {
    int64_t k, total, step;
    counter c = {0, 0, 0};
    plm_context *ctx = NULL;
    plm_status s = PLM_OK;
    (void)state;
    plm_context_create_with_allocator(PLM_API_VERSION, counting_allocate, counting_release, &c, &ctx);
    whole_run(ctx);
    plm_context_destroy(&ctx);
    total = c.total;
    step = 1 + total / 60;
    for (k = 1; k < total; k += step) {
        c.total = 0, c.fail_at = k;
        plm_context_create_with_allocator(PLM_API_VERSION, counting_allocate, counting_release, &c, &ctx);
        s = whole_run(ctx);
        plm_context_destroy(&ctx);
        if (s != PLM_ERR_MEMORY || c.live != 0)
            printf("    allocation %lld of %lld: status %d, %lld blocks left\n", (long long)k,
                   (long long)total, (int)s, (long long)c.live);
        assert_int_equal(c.live, 0);
        assert_int_equal(s, PLM_ERR_MEMORY);
    }
}

/* ---- log and progress ---- */
typedef struct {
    plm_context *ctx;
    plm_model *model;
    int logs, steps, cancel_after, wrong_context, rounding, odd_values;
    plm_status inner[3];
} listener;

static void on_log(plm_context *ctx, int32_t level, const char *text, void *user) {
    listener *l = (listener *)user;
    ++l->logs;
    l->wrong_context |= ctx != l->ctx;
    l->odd_values |= level < 0 || level > 2 || text[0] == 0;
}
static int32_t on_progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    listener *l = (listener *)user;
    int64_t n;
    plm_context *self = ctx;
    ++l->steps;
    l->wrong_context |= ctx != l->ctx;
    l->odd_values |= !(fraction >= 0 && fraction <= 1) || stage[0] == 0;
    l->rounding = fegetround();
    l->inner[0] = plm_model_get_int(l->model, "n_dof", &n);
    l->inner[1] = plm_context_destroy(&self);
    l->inner[2] = plm_context_set_log(ctx, NULL, NULL);
    return l->cancel_after && l->steps >= l->cancel_after;
}

static void log_and_progress_are_heard(void **state) {
    listener l;
    plm_context *ctx = NULL;
    chain c;
    plm_status s;
    (void)state;
    chain_fill(&c);
    memset(&l, 0, sizeof l);
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    l.ctx = ctx;
    plm_context_set_log(ctx, on_log, &l);
    plm_context_set_progress(ctx, on_progress, &l);
    assert_int_equal(chain_model(ctx, &c, 1, &l.model), PLM_OK);
    s = plm_model_build(l.model);
    assert_true(done(ctx, s));
    assert_true(done(ctx, plm_model_solve_rest(l.model)));
    assert_true(l.steps > 0 && l.logs > 0 && !l.wrong_context && !l.odd_values);
    /* calls from inside are refused and do not disturb the one that runs */
    assert_int_equal(l.inner[0], PLM_ERR_STATE);
    assert_int_equal(l.inner[1], PLM_ERR_STATE);
    assert_int_equal(l.inner[2], PLM_ERR_STATE);
    plm_context_destroy(&ctx);
}

static void progress_cancels(void **state) {
    listener l;
    plm_context *ctx = NULL;
    chain c;
    int32_t reason = 0;
    int64_t n = 7;
    (void)state;
    chain_fill(&c);
    memset(&l, 0, sizeof l);
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    l.ctx = ctx, l.cancel_after = 1;
    assert_int_equal(chain_model(ctx, &c, 1, &l.model), PLM_OK);
    plm_context_set_progress(ctx, on_progress, &l);
    assert_int_equal(plm_model_build(l.model), PLM_CANCELLED);
    plm_context_get_error_info(ctx, NULL, &reason, NULL, NULL);
    assert_int_equal(reason, PLM_REASON_CANCELLED);
    assert_int_equal(plm_model_get_int(l.model, "n_free", &n), PLM_ERR_STATE); /* nothing was built */
    l.cancel_after = 0;
    assert_true(done(ctx, plm_model_build(l.model)));
    plm_context_destroy(&ctx);
}

/* ---- the host's own solver: dense elimination without pivoting ---- */
typedef struct {
    int64_t n, fail, factors, indefinite, counted, more, solves, live;
    int64_t fail_factor, fail_solve; /* these calls fail, from 1; 0: none */
    plm_context *ctx;
    int wrong;
} solver;
typedef struct {
    int64_t n;
    double a[CHAIN_DOFS * CHAIN_DOFS];
} dense;

static int32_t dense_factor(plm_context *ctx, int64_t n, const int64_t *col_ptr, const int64_t *row,
                            const double *value, int32_t positive_definite, void **factor, void *user) {
    solver *s = (solver *)user;
    dense *d;
    int64_t i, j, k, p;
    s->wrong |= ctx != s->ctx || n > CHAIN_DOFS || col_ptr[0] != 0;
    ++s->factors, s->indefinite += !positive_definite;
    if (s->fail) return (int32_t)s->fail;
    if (s->factors == s->fail_factor) return 42;
    d = (dense *)calloc(1, sizeof *d);
    d->n = n;
    for (j = 0; j < n; ++j)
        for (p = col_ptr[j]; p < col_ptr[j + 1]; ++p) {
            s->wrong |= row[p] < j || (p > col_ptr[j] && row[p] <= row[p - 1]);
            d->a[row[p] * n + j] = d->a[j * n + row[p]] = value[p];
        }
    for (k = 0; k < n; ++k) {
        if (d->a[k * n + k] == 0 || (positive_definite && d->a[k * n + k] < 0)) {
            free(d);
            return 100 + (int32_t)k;
        }
        for (i = k + 1; i < n; ++i) {
            const double l = d->a[i * n + k] /= d->a[k * n + k];
            for (j = k + 1; j < n; ++j) d->a[i * n + j] -= l * d->a[k * n + j];
        }
    }
    ++s->live;
    *factor = d;
    return 0;
}
static int32_t dense_solve(plm_context *ctx, void *factor, int64_t nrhs, double *x, int64_t ldx, void *user) {
    const dense *d = (const dense *)factor;
    int64_t i, j, r;
    solver *s = (solver *)user;
    s->wrong |= ctx != s->ctx;
    if (++s->solves == s->fail_solve) return 42;
    for (r = 0; r < nrhs; ++r, x += ldx) {
        for (i = 0; i < d->n; ++i)
            for (j = 0; j < i; ++j) x[i] -= d->a[i * d->n + j] * x[j];
        for (i = d->n; i-- > 0;) {
            for (j = i + 1; j < d->n; ++j) x[i] -= d->a[i * d->n + j] * x[j];
            x[i] /= d->a[i * d->n + i];
        }
    }
    return 0;
}
static void dense_free(plm_context *ctx, void *factor, void *user) {
    solver *s = (solver *)user;
    s->wrong |= ctx != s->ctx;
    --s->live;
    free(factor);
}

static void the_hosts_solver_serves(void **state) {
    solver s;
    plm_context *ctx = NULL;
    plm_model *with = NULL, *without = NULL;
    double hz_with[4], hz_without[4], local_with = 0, local_without = 1;
    int64_t count = 0;
    int j;
    (void)state;
    memset(&s, 0, sizeof s);
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    s.ctx = ctx;
    assert_true(refused(ctx, plm_context_set_solver(ctx, dense_factor, NULL, dense_free, &s),
                        PLM_ERR_ARGUMENT, "plm_context_set_solver", "solve", -1, "all three"));
    assert_true(done(ctx, chain_built(ctx, 1, &without)));
    assert_int_equal(plm_context_set_solver(ctx, dense_factor, dense_solve, dense_free, &s), PLM_OK);
    assert_true(done(ctx, chain_built(ctx, 1, &with)));
    assert_true(s.factors > 0 && s.solves > 0 && s.live > 0 && !s.wrong);
    plm_model_get_double(with, "local_stiffness", &local_with);
    plm_model_get_double(without, "local_stiffness", &local_without);
    assert_true(close_to(local_with, local_without, 1e-10));
    assert_true(done(ctx, plm_model_get_modes(with, PLM_SYSTEM_SLIDING, NULL, 4, hz_with, NULL)));
    assert_true(done(ctx, plm_model_get_modes(without, PLM_SYSTEM_SLIDING, NULL, 4, hz_without, NULL)));
    for (j = 0; j < 4; ++j) assert_true(close_to(hz_with[j], hz_without[j], 1e-8));
    assert_true(refused(ctx, plm_model_count_modes(with, hz_with[3], &count), PLM_ERR_STATE,
                        "plm_model_count_modes", "model", -1, "inertia"));
    plm_model_destroy(&with);
    assert_int_equal(s.live, 0);
    plm_context_destroy(&ctx);
    assert_false(s.wrong);
}

/* Of U in the elimination, whose diagonal has the signs of the eigenvalues, plus `more`. */
static int32_t dense_inertia(plm_context *ctx, void *factor, int64_t *negative, void *user) {
    const dense *d = (const dense *)factor;
    solver *s = (solver *)user;
    int64_t k;
    s->wrong |= ctx != s->ctx;
    ++s->counted;
    *negative = s->more;
    for (k = 0; k < d->n; ++k) *negative += d->a[k * d->n + k] < 0;
    return 0;
}

static plm_status described(plm_context *ctx, char *text) {
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    int64_t needed;
    plm_status s = chain_built(ctx, 1, &model);
    if (s >= 0) s = plm_sampler_create(model, &sampler);
    if (s >= 0) s = plm_sampler_run(sampler);
    if (s >= 0) s = plm_sampler_get_string(sampler, "space_description", 400, text, &needed);
    plm_model_destroy(&model);
    plm_sampler_destroy(&sampler);
    return s;
}

/* Without the callback no factorization is made for a number that nobody can tell, and the modes are said to
 * be unverified; with it every indefinite factorization is one that counts, and a wrong count is found out.
 */
static void modes_are_verified_by_the_hosts_inertia(void **state) {
    solver s;
    plm_context *ctx = NULL;
    char text[400];
    (void)state;
    memset(&s, 0, sizeof s);
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    s.ctx = ctx;
    assert_true(refused(ctx, plm_context_set_inertia(ctx, dense_inertia), PLM_ERR_STATE,
                        "plm_context_set_inertia", "inertia", -1, "set one first"));
    assert_int_equal(plm_context_set_inertia(ctx, NULL), PLM_OK);
    assert_int_equal(plm_context_set_solver(ctx, dense_factor, dense_solve, dense_free, &s), PLM_OK);
    assert_true(described(ctx, text) >= 0);
    assert_int_equal(s.indefinite, 0);
    assert_non_null(strstr(text, "not verified"));
    assert_int_equal(plm_context_set_inertia(ctx, dense_inertia), PLM_OK);
    assert_true(described(ctx, text) >= 0);
    assert_true(s.counted > 0 && s.indefinite == s.counted);
    assert_null(strstr(text, "not verified"));
    s.more = -1;
    assert_int_equal(described(ctx, text), PLM_ERR_EIGENSOLVER);
    s.more = 1000;
    assert_int_equal(described(ctx, text), PLM_ERR_CALLBACK);
    assert_int_equal(s.live, 0);
    assert_false(s.wrong);
    plm_context_destroy(&ctx);
}

static void a_failing_solver_is_reported(void **state) {
    solver s;
    plm_context *ctx = NULL;
    plm_model *model = NULL;
    plm_status got;
    int64_t code = 0;
    (void)state;
    memset(&s, 0, sizeof s);
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    s.ctx = ctx, s.fail = 42;
    plm_context_set_solver(ctx, dense_factor, dense_solve, dense_free, &s);
    got = chain_built(ctx, 0, &model);
    plm_context_get_error_info(ctx, NULL, NULL, NULL, &code);
    assert_int_equal(got, PLM_ERR_CALLBACK);
    assert_int_equal(code, 42);
    plm_context_destroy(&ctx);
}

/* A whole way with that many good calls. */
static plm_status one_call(plm_context *ctx, solver *s, int64_t fail_factor, int64_t fail_solve,
                           double *amplitude) {
    plm_model *model = NULL;
    plm_status got;
    double hz, error;
    s->factors = s->solves = 0, s->fail_factor = fail_factor, s->fail_solve = fail_solve;
    got = chain_built(ctx, 1, &model);
    if (got >= 0)
        got = plm_model_compute_response(model, 12, PLM_PEAK, 1e-2, &hz, amplitude, &error, NULL, NULL);
    plm_model_destroy(&model);
    return got;
}

/* Also the first one: a solver says by a failure that K is singular, but a regular K was not meant to fail.
 */
static void a_failure_of_the_solver_is_never_taken_for_an_answer(void **state) {
    solver s;
    plm_context *ctx = NULL;
    double amplitude = 0, again = 0;
    int64_t k, code, factors, solves;
    (void)state;
    memset(&s, 0, sizeof s);
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    s.ctx = ctx;
    plm_context_set_solver(ctx, dense_factor, dense_solve, dense_free, &s);
    assert_true(one_call(ctx, &s, 0, 0, &amplitude) >= 0);
    factors = s.factors, solves = s.solves;
    for (k = 1; k <= factors + solves; k += next_case(7)) {
        const plm_status got = one_call(ctx, &s, k <= factors ? k : 0, k > factors ? k - factors : 0, &again);
        plm_context_get_error_info(ctx, NULL, NULL, NULL, &code);
        if (got != PLM_ERR_CALLBACK || code != 42)
            print_message("call %d of %d factors, %d solves: status %d, code %d\n", (int)k, (int)factors,
                          (int)solves, (int)got, (int)code);
        assert_int_equal(got, PLM_ERR_CALLBACK);
        assert_int_equal(code, 42);
    }
    assert_true(one_call(ctx, &s, 0, 0, &again) >= 0 && again == amplitude);
    assert_int_equal(s.live, 0);
    plm_context_destroy(&ctx);
}

/* ---- the floating-point environment ---- */
static void rounding_and_flags_stay_the_hosts(void **state) {
    plm_context *ctx = NULL;
    listener l;
    chain c;
    double hz[3], same[3];
    plm_status s;
    int rounding, flags;
    (void)state;
    chain_fill(&c);
    memset(&l, 0, sizeof l);
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    l.ctx = ctx;
    plm_context_set_progress(ctx, on_progress, &l);
    assert_int_equal(chain_model(ctx, &c, 1, &l.model), PLM_OK);
    fesetround(FE_UPWARD);
    feclearexcept(FE_ALL_EXCEPT);
    feraiseexcept(FE_OVERFLOW);
    flags = fetestexcept(FE_ALL_EXCEPT);
    s = plm_model_build(l.model);
    if (!s) s = plm_model_get_modes(l.model, PLM_SYSTEM_OPEN, NULL, 3, hz, NULL);
    flags ^= fetestexcept(FE_ALL_EXCEPT & ~FE_INEXACT) &
             ~FE_INEXACT; /* the callback's own arithmetic may be inexact */
    rounding = fegetround();
    fesetround(FE_TONEAREST);
    flags &= ~FE_INEXACT;
    feclearexcept(FE_ALL_EXCEPT);
    assert_true(done(ctx, s));
    assert_int_equal(rounding, FE_UPWARD);
    assert_int_equal(l.rounding, FE_UPWARD); /* the host's code runs in the host's environment */
    assert_int_equal(flags, 0);
    assert_true(done(ctx, plm_model_get_modes(l.model, PLM_SYSTEM_OPEN, NULL, 3, same, NULL)));
    assert_memory_equal(hz, same, sizeof hz);
    plm_context_destroy(&ctx);
}

#ifdef __GLIBC__
static void a_trapping_host_survives(void **state) {
    plm_context *ctx = NULL;
    plm_status s;
    int traps;
    (void)state;
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
    s = whole_run(ctx);
    traps = fegetexcept();
    fedisableexcept(FE_ALL_EXCEPT);
    assert_int_equal(traps, FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
    assert_true(done(ctx, s));
    plm_context_destroy(&ctx);
}
#endif

static void errors_can_be_read_in_full(void **state) {
    plm_context *ctx = NULL;
    plm_model *m = NULL;
    char small[6], whole[500];
    int64_t needed = 0;
    plm_status status = 9;
    int32_t reason = 9;
    int64_t index = 9, code = 9;
    (void)state;
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    assert_int_equal(plm_context_get_error_text(ctx, 500, whole, &needed), PLM_OK);
    assert_true(whole[0] == 0 && needed == 1);
    assert_int_equal(plm_context_get_error_info(ctx, &status, &reason, &index, &code), PLM_OK);
    assert_true(status == 0 && reason == 0 && index == -1 && code == 0);
    assert_int_equal(plm_model_create(ctx, -5, &m), PLM_ERR_ARGUMENT);
    assert_int_equal(plm_context_get_error_text(ctx, 500, whole, &needed), PLM_OK);
    assert_int_equal(needed, strlen(whole) + 1);
    assert_int_equal(plm_context_get_error_text(ctx, 6, small, &needed), PLM_OK);
    assert_string_equal(small, "plm_m");
    assert_int_equal(plm_context_get_error_info(ctx, NULL, NULL, NULL, NULL), PLM_OK);
    plm_context_destroy(&ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_can_be_read_in_full),
        cmocka_unit_test(log_and_progress_are_heard),
        cmocka_unit_test(progress_cancels),
        cmocka_unit_test(the_hosts_solver_serves),
        cmocka_unit_test(modes_are_verified_by_the_hosts_inertia),
        cmocka_unit_test(a_failing_solver_is_reported),
        cmocka_unit_test(a_failure_of_the_solver_is_never_taken_for_an_answer),
        cmocka_unit_test(rounding_and_flags_stay_the_hosts),
#ifdef __GLIBC__
        cmocka_unit_test(a_trapping_host_survives),
#endif
        cmocka_unit_test(all_memory_comes_back),
        cmocka_unit_test(memory_comes_back_after_any_failure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
