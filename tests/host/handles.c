/* Every function of plm.h, from a table made from the header: with a handle that is NULL, foreign, stale or
 * of another kind it answers PLM_ERR_HANDLE; called from inside a callback, PLM_ERR_STATE; with a good handle
 * and nothing else it answers something. Never a crash (the sanitizer presets and valgrind run this too). */
#include "calls.h"
#include "chain.h"
#include "check_host.h"
#include <stddef.h>
#include <string.h>

typedef struct {
    void *of[N_KINDS];
} handles;

static plm_status make(handles *h, int build) {
    plm_status s = plm_context_create(PLM_API_VERSION, (plm_context **)&h->of[KIND_CONTEXT]);
    plm_context *ctx = (plm_context *)h->of[KIND_CONTEXT];
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *branch = NULL;
    plm_transient *transient = NULL;
    plm_study *study = NULL;
    if (!s) s = build ? chain_built(ctx, 1, &model) : plm_model_create(ctx, 3, &model);
    if (!s) s = plm_sampler_create(model, &sampler);
    if (!s) s = plm_basis_create(model, &basis);
    if (!s) s = plm_hbm_create(basis, &hbm);
    if (!s) s = plm_hbm_set_int(hbm, "n_harmonics", 1); /* every function runs under valgrind, too */
    if (!s && build) {
        s = plm_sampler_run(sampler);
        if (!s) s = plm_basis_set_sampler(basis, sampler);
        if (!s) s = plm_basis_build(basis);
        if (s >= 0) s = plm_hbm_solve(hbm, 1.0, NULL, 0, &branch);
    }
    if (s >= 0 && plm_transient_create(model, basis, &transient) == PLM_ERR_NOT_BUILT) transient = NULL;
    if (s >= 0 && plm_study_create(model, &study) == PLM_ERR_NOT_BUILT) study = NULL;
    h->of[KIND_TRANSIENT] = transient, h->of[KIND_STUDY] = study;
    h->of[KIND_MODEL] = model, h->of[KIND_SAMPLER] = sampler, h->of[KIND_BASIS] = basis;
    h->of[KIND_HBM] = hbm, h->of[KIND_BRANCH] = branch;
    return s < 0 ? s : PLM_OK;
}

static void note(const api_call *f, const char *what, plm_status got) {
    ++wrong_count;
    printf("%s, %s: status %d\n", f->name, what, (int)got);
}

/* Every function that does not take this kind refuses the handle. gone: the kind it was of, which may be
 * destroyed again, or -1 */
static void all_refuse(void *handle, int kind, int gone, const char *what) {
    int k;
    for (k = 0; k < n_api_calls; ++k) {
        const api_call *f = &api_calls[k];
        void *copy = handle;
        plm_status s;
        if (f->how == FREE || f->kind == kind) continue;
        if (f->how == DESTROYS && !handle) continue; /* nothing to destroy is fine */
        s = f->call(f->how == DESTROYS ? (void *)&copy : handle);
        if (f->how == DESTROYS && f->kind == gone) {
            if (s != PLM_OK || copy != NULL) note(f, what, s);
        } else if (s != PLM_ERR_HANDLE || copy != handle)
            note(f, what, s);
    }
}

static void bad_handles(void) {
    double somewhere[2] = {0, 0};
    handles live, stale;
    int k;
    all_refuse(NULL, -1, -1, "NULL");
    all_refuse(somewhere, -1, -1, "foreign");
    all_refuse((char *)somewhere + 1, -1, -1, "odd foreign");
    all_refuse((void *)~(uintptr_t)0, -1, -1, "all bits");
    EXPECT(make(&live, 1) == PLM_OK);
    for (k = 0; k < N_KINDS; ++k) all_refuse(live.of[k], k, -1, "of another kind");
    stale = live;
    EXPECT(plm_context_destroy((plm_context **)&live.of[KIND_CONTEXT]) == PLM_OK);
    for (k = 0; k < N_KINDS; ++k) all_refuse(stale.of[k], -1, k, "stale");
    EXPECT(make(&live, 1) == PLM_OK); /* new objects in the same places */
    for (k = 0; k < N_KINDS; ++k) all_refuse(stale.of[k], -1, k, "stale, place taken");
    EXPECT(plm_context_destroy((plm_context **)&live.of[KIND_CONTEXT]) == PLM_OK);
}

/* a bad second handle with a good first */
static void bad_second_handles(void) {
    double somewhere[2] = {0, 0};
    handles live, foreign;
    int k, j;
    EXPECT(make(&live, 1) == PLM_OK);
    EXPECT(make(&foreign, 1) == PLM_OK);
    for (k = 0; k < n_api_calls; ++k) {
        const api_call *f = &api_calls[k];
        plm_status s;
        if (!f->second) continue;
        if ((s = f->second(live.of[f->kind], somewhere)) >= 0) note(f, "foreign second handle", s);
        for (j = 0; j < N_KINDS; ++j)
            if ((s = f->second(live.of[f->kind], foreign.of[j])) >= 0)
                note(f, "second handle of another context", s);
    }
    plm_context_destroy((plm_context **)&live.of[KIND_CONTEXT]);
    plm_context_destroy((plm_context **)&foreign.of[KIND_CONTEXT]);
}

static void destroyed_twice(void) {
    int k, order;
    for (order = 0; order < 2; ++order) { /* parents first, children first */
        handles h;
        EXPECT(make(&h, 1) == PLM_OK);
        for (k = 0; k < n_api_calls; ++k) {
            const api_call *f = &api_calls[order ? n_api_calls - 1 - k : k];
            void *handle, *copy;
            if (f->how != DESTROYS || f->kind == KIND_CONTEXT) continue;
            handle = copy = h.of[f->kind];
            EXPECT(f->call(&handle) == PLM_OK && handle == NULL);
            EXPECT(f->call(&handle) == PLM_OK);               /* nulled: fine */
            EXPECT(f->call(&copy) == PLM_OK && copy == NULL); /* gone already: nothing to do */
            EXPECT(f->call(NULL) == PLM_OK);
        }
        EXPECT(plm_context_destroy((plm_context **)&h.of[KIND_CONTEXT]) == PLM_OK);
    }
}

static void nothing_but_a_handle(void) {
    int k, build;
    for (build = 0; build < 2; ++build) {
        handles h;
        EXPECT(make(&h, build) == PLM_OK);
        for (k = 0; k < n_api_calls; ++k) {
            const api_call *f = &api_calls[k];
            plm_status s;
            if (f->how == DESTROYS || (f->how == TAKES && !h.of[f->kind])) continue;
            s = f->call(h.of[f->kind]);
            if (s == PLM_ERR_INTERNAL || (s == PLM_ERR_HANDLE && !f->second) || s < PLM_ERR_BUSY ||
                s > PLM_WARNING)
                note(f, "all zero", s);
        }
        EXPECT(plm_context_destroy((plm_context **)&h.of[KIND_CONTEXT]) == PLM_OK);
    }
}

typedef struct {
    handles *h;
    int calls, done;
} inside;

static void call_everything(inside *in) {
    int k;
    if (in->done++) return;
    for (k = 0; k < n_api_calls; ++k) {
        const api_call *f = &api_calls[k];
        void *copy = in->h->of[f->kind];
        plm_status s;
        if (f->how == FREE) continue;
        s = f->call(f->how == DESTROYS ? (void *)&copy : copy);
        if (s != PLM_ERR_STATE || copy != in->h->of[f->kind]) note(f, "from inside a callback", s);
        ++in->calls;
    }
}
static void on_log(plm_context *ctx, int32_t level, const char *text, void *user) {
    (void)ctx, (void)level, (void)text;
    call_everything((inside *)user);
}
static int32_t on_progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    (void)ctx, (void)stage, (void)fraction;
    call_everything((inside *)user);
    return 0;
}

static void called_from_inside(void) {
    handles h;
    inside from_log, from_progress;
    plm_branch *branch = NULL;
    plm_context *ctx;
    EXPECT(make(&h, 1) == PLM_OK);
    from_log.h = from_progress.h = &h;
    from_log.calls = from_log.done = from_progress.calls = from_progress.done = 0;
    ctx = (plm_context *)h.of[KIND_CONTEXT];
    plm_context_set_log(ctx, on_log, &from_log);
    plm_context_set_progress(ctx, on_progress, &from_progress);
    EXPECT(plm_sampler_run((plm_sampler *)h.of[KIND_SAMPLER]) >= 0);
    EXPECT(plm_hbm_sweep((plm_hbm *)h.of[KIND_HBM], &branch) >= 0 && branch != NULL);
    EXPECT(from_log.calls > 80 && from_progress.calls > 80);
    EXPECT(plm_context_destroy(&ctx) == PLM_OK);
}

int main(void) {
    bad_handles();
    bad_second_handles();
    destroyed_twice();
    nothing_but_a_handle();
    called_from_inside();
    printf("%d functions\n", n_api_calls);
    return wrong();
}
