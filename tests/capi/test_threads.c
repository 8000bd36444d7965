/* Different contexts run at once, with the results they have alone. */
#define _POSIX_C_SOURCE 200809L
#include "chain.h"
#include "check.h"
#include <pthread.h>

enum { THREADS = 4, ROUNDS = 5 };

typedef struct {
    double hz[4], blf_hz, amplitude;
    plm_status status;
} outcome;

static plm_status run(plm_context *ctx, outcome *o) {
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *branch = NULL;
    int64_t n;
    plm_status s = chain_built(ctx, 1, &model);
    if (!s) s = plm_model_get_modes(model, PLM_SYSTEM_SLIDING, NULL, 4, o->hz, NULL);
    if (!s) s = plm_sampler_create(model, &sampler);
    if (!s) s = plm_sampler_run(sampler);
    if (!s) s = plm_sampler_get_double(sampler, "blf_hz", &o->blf_hz);
    if (!s) s = plm_basis_create(model, &basis);
    if (!s) s = plm_basis_set_sampler(basis, sampler);
    if (!s) s = plm_basis_build(basis);
    if (s > 0) s = 0;
    if (!s) s = plm_hbm_create(basis, &hbm);
    if (!s) s = plm_hbm_solve(hbm, o->blf_hz, NULL, 0, &branch);
    if (!s) s = plm_branch_get_amplitude(branch, 12, PLM_PEAK, 0, 1, &o->amplitude, &n);
    return s;
}

static void *thread(void *user) {
    outcome *o = (outcome *)user;
    int k;
    for (k = 0; k < ROUNDS && !o->status; ++k) {
        plm_context *ctx = NULL;
        o->status = plm_context_create(PLM_API_VERSION, &ctx);
        if (!o->status) o->status = run(ctx, o);
        plm_context_destroy(&ctx);
    }
    return NULL;
}

static void contexts_run_at_once(void **state) {
    outcome alone, together[THREADS];
    pthread_t id[THREADS];
    int k;
    (void)state;
    memset(&alone, 0, sizeof alone);
    memset(together, 0, sizeof together);
    thread(&alone);
    for (k = 0; k < THREADS; ++k) pthread_create(&id[k], NULL, thread, &together[k]);
    for (k = 0; k < THREADS; ++k) pthread_join(id[k], NULL);
    assert_int_equal(alone.status, PLM_OK);
    for (k = 0; k < THREADS; ++k) assert_memory_equal(&alone, &together[k], sizeof alone);
}

/* While one thread is inside a call, every other call of the context is refused: from that thread, inside a
 * callback, and from another one, which is told so by a status of its own. */
typedef struct {
    plm_context *ctx;
    plm_model *model;
    plm_status inside, beside, destroyed;
} caller;

static void *from_another_thread(void *user) {
    caller *c = (caller *)user;
    plm_model *copy = c->model;
    c->beside = plm_model_set_int(c->model, "max_blocks", 3);
    c->destroyed = plm_model_destroy(&copy);
    return NULL;
}
static int32_t from_a_callback(plm_context *ctx, const char *stage, double fraction, void *user) {
    caller *c = (caller *)user;
    pthread_t id;
    (void)ctx, (void)stage, (void)fraction;
    c->inside = plm_model_set_int(c->model, "max_blocks", 3);
    if (pthread_create(&id, NULL, from_another_thread, c) == 0) pthread_join(id, NULL);
    return 1;
}

static void a_busy_context_says_who_is_at_fault(void **state) {
    caller c = {NULL, NULL, PLM_OK, PLM_OK, PLM_OK};
    plm_model *other = NULL;
    char text[300] = "";
    (void)state;
    assert_int_equal(plm_context_create(PLM_API_VERSION, &c.ctx), PLM_OK);
    assert_int_equal(chain_built(c.ctx, 1, &c.model), PLM_OK);
    assert_int_equal(plm_context_set_progress(c.ctx, from_a_callback, &c), PLM_OK);
    assert_int_equal(chain_built(c.ctx, 1, &other), PLM_CANCELLED);
    assert_int_equal(c.inside, PLM_ERR_STATE);
    assert_int_equal(c.beside, PLM_ERR_BUSY);
    assert_int_equal(c.destroyed, PLM_ERR_BUSY);
    assert_int_equal(plm_status_text(PLM_ERR_BUSY, sizeof text, text, NULL), PLM_OK);
    assert_non_null(strstr(text, "another thread"));
    assert_non_null(strstr(text, "a context of its own"));
    from_another_thread(&c);                   /* when the call is over, any thread may go on */
    assert_int_equal(c.beside, PLM_ERR_STATE); /* built: no longer changes */
    assert_int_equal(c.destroyed, PLM_OK);
    plm_context_destroy(&c.ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(contexts_run_at_once),
                                       cmocka_unit_test(a_busy_context_says_who_is_at_fault)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
