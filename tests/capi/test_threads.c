/* Different contexts run at once, with the results they have alone; and a context that uses several threads
 * has the results of one. */
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

/* A block of nodes joined to their neighbours, large enough for products and solutions to be shared out: one
 * DOF a node, held at one end and meeting stops at the other. */
enum { NX = 44, NY = 22, NZ = 22, NODES = NX * NY * NZ, STOPS = 96, COLUMNS = 4 };

typedef struct {
    int64_t size, points, count;
    double hz[4], vector[COLUMNS][NODES], amplitude[64];
    plm_status status;
} block_outcome;

typedef struct {
    pthread_t owner;
    int calls, elsewhere;
} listener;

static void note(listener *l) {
    ++l->calls;
    l->elsewhere += !pthread_equal(l->owner, pthread_self());
}
static void on_log(plm_context *ctx, int32_t level, const char *text, void *user) {
    (void)ctx, (void)level, (void)text;
    note((listener *)user);
}
static int32_t on_progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    (void)ctx, (void)stage, (void)fraction;
    note((listener *)user);
    return 0;
}

static int64_t block_matrices(int32_t *row, int32_t *col, double *k) {
    const int step[] = {1, NX, NX * NY}, size[] = {NX, NY, NZ};
    int64_t n = 0;
    int node, axis, at;
    for (node = 0; node < NODES; ++node) {
        int neighbours = 0, rest = node;
        for (axis = 0; axis < 3; ++axis, rest /= size[axis - 1]) {
            at = rest % size[axis];
            neighbours += (at > 0) + (at + 1 < size[axis]);
            if (at == 0) continue;
            row[n] = node, col[n] = node - step[axis], k[n++] = -1;
        }
        row[n] = col[n] = node, k[n++] = neighbours;
    }
    return n;
}

static plm_status build_block(plm_context *ctx, plm_model **model) {
    static int32_t row[4 * NODES], col[4 * NODES], all[NODES], held[NY * NZ], stop[3 * STOPS];
    static double k[4 * NODES], m[NODES], load[NODES], normal[3 * STOPS], k_n[STOPS], gap[STOPS];
    const int64_t nnz = block_matrices(row, col, k);
    plm_status s;
    int i;
    for (i = 0; i < NODES; ++i) all[i] = i, m[i] = 1, load[i] = i % NX == NX - 1 ? 1.0 + i % 7 : 0;
    for (i = 0; i < NY * NZ; ++i) held[i] = NX * i;
    for (i = 0; i < STOPS; ++i) {
        stop[3 * i] = NX * (5 * i + 3) + NX - 1, stop[3 * i + 1] = stop[3 * i + 2] = -1;
        normal[3 * i] = 1, k_n[i] = 0.5, gap[i] = 50 + 5 * i;
    }
    s = plm_model_create(ctx, NODES, model);
    if (!s)
        s = plm_model_set_matrix_i32(*model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, NODES, all, all,
                                     m);
    if (!s)
        s = plm_model_set_matrix_i32(*model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, nnz, row,
                                     col, k);
    if (!s) s = plm_model_fix_dofs_i32(*model, 0, NY * NZ, held);
    if (!s) s = plm_model_add_ground_contacts_i32(*model, 0, STOPS, stop, normal, k_n, gap);
    if (!s) s = plm_model_set_rayleigh_damping(*model, 0, 1);
    if (!s) s = plm_model_set_excitation(*model, 1, NODES, load, NULL);
    if (!s) s = plm_model_build(*model);
    return s;
}

static plm_status run_block(plm_context *ctx, block_outcome *o) {
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *branch = NULL;
    double hz = 0;
    plm_status s = build_block(ctx, &model);
    if (!s) s = plm_sampler_create(model, &sampler);
    if (!s) s = plm_sampler_set_int(sampler, "n_samples", 7);
    if (!s) s = plm_sampler_set_int(sampler, "n_harmonics", 3);
    if (s >= 0) s = plm_sampler_run(sampler);
    if (s >= 0) s = plm_basis_create(model, &basis);
    if (s >= 0) s = plm_basis_set_sampler(basis, sampler);
    if (s >= 0) s = plm_basis_build(basis);
    if (s >= 0) s = plm_basis_get_int(basis, "size", &o->size);
    if (s >= 0) s = plm_basis_get_vectors(basis, 0, 0, COLUMNS, o->vector[0], NODES);
    if (s >= 0) s = plm_model_get_modes(model, PLM_SYSTEM_SLIDING, NULL, 4, o->hz, NULL);
    if (s >= 0) s = plm_sampler_get_double(sampler, "blf_hz", &hz);
    if (s >= 0) s = plm_hbm_create(basis, &hbm);
    if (s >= 0) s = plm_hbm_set_int(hbm, "n_harmonics", 3);
    if (s >= 0) s = plm_hbm_solve(hbm, hz, NULL, 0, &branch);
    if (s >= 0) s = plm_branch_get_amplitude(branch, NX - 1, PLM_PEAK, 0, 64, o->amplitude, &o->count);
    return s;
}

#ifdef __SANITIZE_THREAD__
enum {
    FEWEST = 3
}; /* threads; watched, each number takes a minute, and results are compared where none watches */
#else
enum { FEWEST = 1 };
#endif

static void a_context_may_use_threads(void **state) {
    static block_outcome one, more;
    int n;
    (void)state;
    for (n = FEWEST; n <= 3; ++n) {
        block_outcome *o = n == FEWEST ? &one : &more;
        plm_context *ctx = NULL;
        listener l = {pthread_self(), 0, 0};
        memset(o, 0, sizeof *o);
        assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
        assert_int_equal(plm_context_set_threads(ctx, n), PLM_OK);
        assert_int_equal(plm_context_set_log(ctx, on_log, &l), PLM_OK);
        assert_int_equal(plm_context_set_progress(ctx, on_progress, &l), PLM_OK);
        assert_true(run_block(ctx, o) >= 0 || done(ctx, PLM_ERR_INTERNAL));
        assert_true(l.calls > 10);
        assert_int_equal(l.elsewhere, 0);
        if (n > FEWEST) assert_memory_equal(&one, &more, sizeof one);
        plm_context_destroy(&ctx);
    }
    assert_true(one.size >= COLUMNS && one.amplitude[0] > 0);
}

static void threads_and_effort_are_checked(void **state) {
    plm_context *ctx = NULL;
    (void)state;
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    assert_true(refused(ctx, plm_context_set_threads(ctx, 0), PLM_ERR_ARGUMENT, "plm_context_set_threads",
                        "n", -1, "n"));
    assert_true(refused(ctx, plm_context_set_threads(ctx, 5000), PLM_ERR_ARGUMENT, "plm_context_set_threads",
                        "n", -1, "n"));
    assert_true(refused(ctx, plm_context_set_effort(ctx, -1), PLM_ERR_ARGUMENT, "plm_context_set_effort",
                        "seconds", -1, "seconds"));
    assert_true(refused(ctx, plm_context_set_effort(ctx, NAN), PLM_ERR_ARGUMENT, "plm_context_set_effort",
                        "seconds", -1, "seconds"));
    plm_context_destroy(&ctx);
    assert_int_equal(plm_context_set_threads(ctx, 2), PLM_ERR_HANDLE);
    assert_int_equal(plm_context_set_effort(ctx, 2), PLM_ERR_HANDLE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contexts_run_at_once), cmocka_unit_test(a_busy_context_says_who_is_at_fault),
        cmocka_unit_test(a_context_may_use_threads), cmocka_unit_test(threads_and_effort_are_checked)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
