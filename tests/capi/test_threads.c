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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(contexts_run_at_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
