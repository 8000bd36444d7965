/* What bases and branches as bytes refuse, argument by argument, with nothing changed, and what is asked of a
 * basis without its model. That numbers come back is tested in tests/python/test_bytes.py. */
#include "chain.h"
#include "check.h"

static plm_context *ctx;
static plm_model *model;
static plm_basis *basis;
static plm_branch *curve;
static plm_hbm *hbm;
static char *basis_bytes, *curve_bytes;
static int64_t basis_size, curve_size;

static char *written(plm_status (*size)(void *, int64_t, void *, int64_t *), void *handle, int64_t *n) {
    char *bytes;
    if (!done(ctx, size(handle, 0, NULL, n)) || !(bytes = malloc((size_t)*n))) return NULL;
    return done(ctx, size(handle, *n, bytes, n)) ? bytes : NULL;
}
static plm_status write_basis(void *b, int64_t capacity, void *bytes, int64_t *n) {
    return plm_basis_write(b, capacity, bytes, n);
}
static plm_status write_branch(void *b, int64_t capacity, void *bytes, int64_t *n) {
    return plm_branch_write(b, capacity, bytes, n);
}

static int set_up(void **state) {
    plm_sampler *sampler = NULL;
    (void)state;
    model = NULL, basis = NULL, curve = NULL, hbm = NULL;
    if (plm_context_create(PLM_API_VERSION, &ctx) || !done(ctx, chain_built(ctx, 0, &model)) ||
        !done(ctx, plm_sampler_create(model, &sampler)) || !done(ctx, plm_sampler_run(sampler)) ||
        !done(ctx, plm_basis_create(model, &basis)) || !done(ctx, plm_basis_set_sampler(basis, sampler)) ||
        !done(ctx, plm_basis_build(basis)) || !done(ctx, plm_hbm_create(basis, &hbm)) ||
        plm_hbm_set_int(hbm, "n_harmonics", 3) || plm_hbm_set_int(hbm, "max_points", 4) ||
        plm_hbm_sweep(hbm, &curve) < 0)
        return 1;
    basis_bytes = written(write_basis, basis, &basis_size);
    curve_bytes = written(write_branch, curve, &curve_size);
    return !basis_bytes || !curve_bytes;
}
static int tear_down(void **state) {
    (void)state;
    free(basis_bytes), free(curve_bytes);
    return plm_context_destroy(&ctx);
}

#define BAD(call, function, argument, words)                                                                 \
    assert_true(refused(ctx, call, PLM_ERR_ARGUMENT, function, argument, -1, words))

static void writing(void **state) {
    int64_t n = 7;
    plm_basis *unbuilt = NULL;
    char byte = 'x';
    (void)state;
    assert_int_equal(plm_basis_write(NULL, 0, NULL, &n), PLM_ERR_HANDLE);
    BAD(plm_basis_write(basis, 0, NULL, NULL), "plm_basis_write", "needed", "NULL");
    BAD(plm_basis_write(basis, -1, &byte, &n), "plm_basis_write", "capacity", "-1");
    BAD(plm_basis_write(basis, 1, NULL, &n), "plm_basis_write", "bytes", "NULL");
    BAD(plm_basis_write(basis, 1, &byte, &n), "plm_basis_write", "capacity", "bytes are to be written");
    BAD(plm_branch_write(curve, 1, &byte, &n), "plm_branch_write", "capacity", "bytes are to be written");
    assert_true(n == 7 && byte == 'x');
    assert_true(done(ctx, plm_basis_create(model, &unbuilt)));
    assert_true(refused(ctx, plm_basis_write(unbuilt, 0, NULL, &n), PLM_ERR_STATE, "plm_basis_write", "basis",
                        -1, "build it first"));
}

static void reading(void **state) {
    const char *f = "plm_basis_read";
    plm_basis *none = NULL;
    plm_branch *no_branch = NULL;
    char *bad = malloc((size_t)basis_size);
    (void)state;
    assert_non_null(bad);
    assert_int_equal(plm_basis_read(NULL, basis_size, basis_bytes, &none), PLM_ERR_HANDLE);
    BAD(plm_basis_read(ctx, basis_size, basis_bytes, NULL), f, "basis", "NULL");
    BAD(plm_basis_read(ctx, 0, basis_bytes, &none), f, "n", "0");
    BAD(plm_basis_read(ctx, basis_size, NULL, &none), f, "bytes", "NULL");
    BAD(plm_basis_read(ctx, 10, basis_bytes, &none), f, "bytes", "fewer than the head");
    BAD(plm_basis_read(ctx, basis_size - 1, basis_bytes, &none), f, "bytes", "cut off");
    BAD(plm_basis_read(ctx, curve_size, curve_bytes, &none), f, "bytes", "those of a branch");
    BAD(plm_branch_read(basis, basis_size, basis_bytes, &no_branch), "plm_branch_read", "bytes",
        "those of a basis");
    memcpy(bad, basis_bytes, (size_t)basis_size), bad[0] ^= 1;
    BAD(plm_basis_read(ctx, basis_size, bad, &none), f, "bytes", "do not begin");
    memcpy(bad, basis_bytes, (size_t)basis_size), bad[16] = 9;
    BAD(plm_basis_read(ctx, basis_size, bad, &none), f, "bytes", "format version 9");
    memcpy(bad, basis_bytes, (size_t)basis_size), bad[basis_size / 2] ^= 4;
    BAD(plm_basis_read(ctx, basis_size, bad, &none), f, "bytes", "checksum");
    assert_true(!none && !no_branch);
    free(bad);
}

static void without_the_model(void **state) {
    plm_basis *read = NULL, *refined = NULL;
    plm_hbm *own = NULL;
    plm_branch *again = NULL;
    plm_model *other = NULL;
    double x = 7, error;
    (void)state;
    assert_true(done(ctx, plm_basis_read(ctx, basis_size, basis_bytes, &read)));
    assert_true(done(ctx, plm_branch_read(read, curve_size, curve_bytes, &again)));
    assert_true(refused(ctx, plm_branch_get_full_residual(again, 0, &x), PLM_ERR_STATE,
                        "plm_branch_get_full_residual", "basis", -1, "attach the model"));
    assert_true(refused(ctx, plm_basis_build(read), PLM_ERR_STATE, "plm_basis_build", "basis", -1, "attach"));
    assert_true(done(ctx, plm_hbm_create(read, &own)));
    assert_int_equal(plm_hbm_refine_basis(own, 0, PLM_PEAK, 0, 1e-3, &refined, &error), PLM_ERR_STATE);
    assert_true(x == 7 && !refined);
    assert_true(done(ctx, chain_built(ctx, 1, &other))); /* under pre-load */
    BAD(plm_basis_attach(read, other), "plm_basis_attach", "model", "loads or the damping");
    assert_int_equal(plm_basis_attach(read, NULL), PLM_ERR_HANDLE);
    assert_true(refused(ctx, plm_basis_attach(basis, model), PLM_ERR_STATE, "plm_basis_attach", "basis", -1,
                        "has its model already"));
    assert_true(done(ctx, plm_basis_attach(read, model)));
    assert_true(done(ctx, plm_branch_read(read, curve_size, curve_bytes, &again)));
    assert_true(done(ctx, plm_branch_get_full_residual(again, 0, &x)) && x < 1);
}

static void another_basis(void **state) {
    plm_basis *full = NULL;
    plm_branch *none = NULL;
    (void)state;
    assert_true(done(ctx, plm_basis_create(model, &full)));
    assert_true(done(ctx, plm_basis_set_string(full, "kind", "full")));
    assert_true(done(ctx, plm_basis_set_double(full, "frequency_min_hz", 1)));
    assert_true(done(ctx, plm_basis_set_double(full, "frequency_max_hz", 30)));
    assert_true(done(ctx, plm_basis_build(full)));
    BAD(plm_branch_read(full, curve_size, curve_bytes, &none), "plm_branch_read", "bytes", "another basis");
    assert_null(none);
}

static void a_table_of_the_curve(void **state) {
    const char *f = "plm_branch_write_csv";
    (void)state;
    BAD(plm_branch_write_csv(curve, 0, PLM_PEAK, 0, NULL), f, "path", "NULL");
    BAD(plm_branch_write_csv(curve, CHAIN_DOFS, PLM_PEAK, 0, "x.csv"), f, "dof", "24");
    BAD(plm_branch_write_csv(curve, 0, 9, 0, "x.csv"), f, "measure", "9");
    BAD(plm_branch_write_csv(curve, 0, PLM_PEAK, 0, "no/such/folder/x.csv"), f, "path", "cannot be written");
}

/* Where the pieces go, and after how many of them there is no more room. */
typedef struct {
    char *bytes;
    int64_t n, pieces, most;
    plm_status inside;
} kept;
static int32_t keep(plm_context *c, int64_t n, const void *bytes, void *user) {
    kept *k = user;
    int64_t value;
    if (k->pieces == k->most) return 28;
    k->pieces++;
    k->inside = plm_basis_get_int(basis, "size", &value); /* not from inside a call */
    if (c != ctx || n < 1 || n > 65536 || !(k->bytes = realloc(k->bytes, (size_t)(k->n + n)))) return 1;
    memcpy(k->bytes + k->n, bytes, (size_t)n);
    k->n += n;
    return 0;
}

static void handing_over(void **state) {
    kept b = {NULL, 0, 0, -1, PLM_OK}, c = {NULL, 0, 0, -1, PLM_OK}, t = {NULL, 0, 0, -1, PLM_OK};
    kept full = {NULL, 0, 0, 0, PLM_OK};
    int64_t code = 0;
    (void)state;
    assert_true(done(ctx, plm_basis_write_to(basis, keep, &b)) &&
                done(ctx, plm_branch_write_to(curve, keep, &c)));
    assert_true(b.n == basis_size && memcmp(b.bytes, basis_bytes, (size_t)b.n) == 0);
    assert_true(b.pieces == (basis_size + 65535) / 65536 && b.inside == PLM_ERR_STATE);
    assert_true(c.n == curve_size && memcmp(c.bytes, curve_bytes, (size_t)c.n) == 0);
    assert_true(done(ctx, plm_branch_write_csv_to(curve, 3, PLM_PEAK, 0, keep, &t)));
    assert_true(done(ctx, plm_branch_write_csv(curve, 3, PLM_PEAK, 0, "test_bytes.csv")));
    FILE *file = fopen("test_bytes.csv", "rb");
    char *text = malloc((size_t)t.n + 1);
    assert_true(file && text && fread(text, 1, (size_t)t.n + 1, file) == (size_t)t.n &&
                memcmp(text, t.bytes, (size_t)t.n) == 0);
    fclose(file), remove("test_bytes.csv");
    assert_true(refused(ctx, plm_basis_write_to(basis, keep, &full), PLM_ERR_CALLBACK, "plm_basis_write_to",
                        "fn", -1, "code 28"));
    assert_int_equal(plm_context_get_error_info(ctx, NULL, NULL, NULL, &code), PLM_OK);
    assert_int_equal(code, 28);
    BAD(plm_basis_write_to(basis, NULL, NULL), "plm_basis_write_to", "fn", "NULL");
    BAD(plm_branch_write_to(curve, NULL, NULL), "plm_branch_write_to", "fn", "NULL");
    BAD(plm_branch_write_csv_to(curve, 0, PLM_PEAK, 0, NULL, NULL), "plm_branch_write_csv_to", "fn", "NULL");
    BAD(plm_branch_write_csv_to(curve, CHAIN_DOFS, PLM_PEAK, 0, keep, &full), "plm_branch_write_csv_to",
        "dof", "24");
    assert_int_equal(plm_basis_write_to(NULL, keep, &full), PLM_ERR_HANDLE);
    assert_int_equal(plm_branch_write_to(NULL, keep, &full), PLM_ERR_HANDLE);
    assert_true(full.n == 0 && !full.bytes);
    free(b.bytes), free(c.bytes), free(t.bytes), free(text);
}

static void going_on(void **state) {
    const char *f = "plm_hbm_resume", *s = "plm_hbm_save_every", *path = "test_bytes_curve.plm";
    plm_branch *whole = NULL, *end = NULL, *none = NULL;
    plm_hbm *other = NULL;
    int64_t few = 0, many = 0;
    (void)state;
    BAD(plm_hbm_save_every(hbm, -1, path), s, "n_points", "-1");
    BAD(plm_hbm_save_every(hbm, 3, NULL), s, "path", "NULL");
    BAD(plm_hbm_save_every(hbm, 3, "no/such/folder/curve.plm"), s, "path", "cannot be written");
    BAD(plm_hbm_save_every(hbm, 3, "."), s, "path", "cannot be written");
    assert_int_equal(plm_hbm_save_every(NULL, 3, path), PLM_ERR_HANDLE);
    assert_int_equal(plm_hbm_resume(NULL, curve, &none), PLM_ERR_HANDLE);
    assert_int_equal(plm_hbm_resume(hbm, NULL, &none), PLM_ERR_HANDLE);
    BAD(plm_hbm_resume(hbm, curve, NULL), f, "resumed", "NULL");
    BAD(plm_hbm_resume(hbm, curve, &none), f, "hbm",
        "max_points"); /* 4 points, which are all that it allows */
    assert_true(done(ctx, plm_hbm_set_int(hbm, "max_points", 100)));
    assert_true(done(ctx, plm_hbm_save_every(hbm, 3, path)));
    assert_true(plm_hbm_resume(hbm, curve, &whole) >= 0);
    assert_true(done(ctx, plm_branch_get_int(curve, "n_points", &few)) &&
                done(ctx, plm_branch_get_int(whole, "n_points", &many)) && few == 4 && many > 20);
    BAD(plm_hbm_resume(hbm, whole, &none), f, "branch", "nothing to go on with");
    assert_true(done(ctx, plm_hbm_save_every(hbm, 0, NULL)) && remove(path) == 0);
    assert_true(plm_hbm_sweep(hbm, &end) >= 0 && remove(path) != 0);
    assert_true(done(ctx, plm_hbm_create(basis, &other)));
    BAD(plm_hbm_resume(other, curve, &none), f, "hbm",
        "n_harmonics = 3; those of this hbm are: the defaults");
    assert_null(none);
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(writing),
        TEST(reading),
        TEST(without_the_model),
        TEST(another_basis),
        TEST(a_table_of_the_curve),
        TEST(handing_over),
        TEST(going_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
