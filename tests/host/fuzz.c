/* libFuzzer over option keys, words and array arguments: whatever the bytes say, a call returns a known
 * status. The first bytes choose the calls, the rest are their arguments. PLM_FUZZ_SECONDS and the corpus:
 * fuzz.cmake. */
#include "plm/plm.h"
#include <stdlib.h>
#include <string.h>

enum { N = 6, TEXT = 40 };

typedef struct {
    const uint8_t *at;
    size_t left;
} bytes;

static void take(bytes *b, void *to, size_t size) {
    const size_t n = size < b->left ? size : b->left;
    memset(to, 0, size);
    if (n) memcpy(to, b->at, n);
    b->at += n, b->left -= n;
}
static int64_t small(bytes *b) { /* mostly sane numbers */
    int8_t v;
    take(b, &v, 1);
    if (v == 127) return INT64_MAX;
    if (v == -128) return INT64_MIN;
    return v % 16;
}
static double number(bytes *b) {
    double v;
    if (small(b) % 2) return (double)small(b);
    take(b, &v, sizeof v);
    return v;
}
static void expect_known(plm_status s) {
    if (s < PLM_ERR_CALLBACK || s > PLM_WARNING) abort(); /* PLM_ERR_INTERNAL is a defect */
}

static void key_calls(bytes *b, plm_model *m, plm_sampler *s, plm_basis *p, plm_hbm *h) {
    char key[TEXT], word[TEXT], text[TEXT];
    int64_t i, n;
    double d;
    take(b, key, TEXT - 1), take(b, word, TEXT - 1);
    key[TEXT - 1] = word[TEXT - 1] = 0;
    if (small(b) % 2) { /* a real key, so that its bounds and words are reached */
        int32_t kind = 1 + (int32_t)(small(b) & 3), count = 1;
        plm_key_count(kind, &count);
        plm_key_text(kind, (int32_t)((small(b) & 15) * 3 % count), PLM_KEY_NAME, TEXT, key, NULL);
    }
    n = small(b), d = number(b);
    expect_known(plm_model_set_int(m, key, n)), expect_known(plm_model_set_double(m, key, d));
    expect_known(plm_model_set_string(m, key, word)), expect_known(plm_model_get_int(m, key, &i));
    expect_known(plm_sampler_set_int(s, key, n)), expect_known(plm_sampler_set_double(s, key, d));
    expect_known(plm_sampler_set_string(s, key, word)),
        expect_known(plm_sampler_get_string(s, key, small(b) & 31, text, &i));
    expect_known(plm_basis_set_int(p, key, n)), expect_known(plm_basis_set_double(p, key, d));
    expect_known(plm_basis_set_string(p, key, word)), expect_known(plm_basis_get_double(p, key, &d));
    expect_known(plm_hbm_set_int(h, key, n)), expect_known(plm_hbm_set_double(h, key, d));
    expect_known(plm_hbm_set_string(h, key, word)),
        expect_known(plm_hbm_get_string(h, key, TEXT, text, NULL));
}

static void array_calls(bytes *b, plm_model *m) {
    int32_t a[32], c[32], base = (int32_t)small(b);
    double v[32], w[32];
    int k;
    /* `n` and nnz stay within what the arrays hold, as a host must see to */
    const int64_t nnz = small(b) & 15, n = small(b) & 7;
    for (k = 0; k < 32; ++k) a[k] = (int32_t)small(b), c[k] = (int32_t)small(b);
    for (k = 0; k < 32; ++k) v[k] = number(b), w[k] = k % 3 ? 0 : 1;
    expect_known(plm_model_set_matrix_i32(m, (int32_t)small(b), (int32_t)small(b), (int32_t)small(b), base,
                                          PLM_COPY, nnz, a, c, v));
    expect_known(plm_model_fix_dofs_i32(m, base, n, a));
    expect_known(plm_model_add_node_pairs_i32(m, base, n, a, c, w, v, w));
    expect_known(plm_model_add_ground_contacts_i32(m, base, n, a, v, v, NULL));
    if (n < 8 && a[n] <= 16 && a[n] >= -16)
        expect_known(plm_model_add_gap_rows_i32(m, base, n, a, c, v, v, w));
    expect_known(plm_model_set_preload(m, small(b), small(b) & 1 ? v : NULL));
    expect_known(plm_model_set_excitation(m, (int32_t)small(b), N, v, small(b) & 1 ? v : NULL));
    expect_known(plm_model_set_modal_damping(m, n, v));
}

static plm_status healthy(plm_model *m) { /* M = I, K = 2 I where the bytes have not set them */
    static const int32_t i[] = {0, 1, 2, 3, 4, 5};
    static const double one[] = {1, 1, 1, 1, 1, 1}, two[] = {2, 3, 4, 5, 6, 7};
    const plm_status s =
        plm_model_set_matrix_i32(m, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, N, i, i, one);
    return s ? s
             : plm_model_set_matrix_i32(m, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, N, i, i, two);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bytes b;
    plm_context *ctx = NULL;
    plm_model *m = NULL;
    plm_sampler *s = NULL;
    plm_basis *p = NULL;
    plm_hbm *h = NULL;
    b.at = data, b.left = size;
    if (plm_context_create(PLM_API_VERSION, &ctx)) abort();
    if (plm_model_create(ctx, N, &m) || plm_sampler_create(m, &s) || plm_basis_create(m, &p) ||
        plm_hbm_create(p, &h))
        abort();
    if (small(&b) % 2) {
        key_calls(&b, m, s, p, h);
    } else {
        if (healthy(m)) abort();
        array_calls(&b, m);
        expect_known(plm_model_build(m));
    }
    if (plm_context_destroy(&ctx)) abort();
    return 0;
}
