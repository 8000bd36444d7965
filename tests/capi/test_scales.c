/* Numbers so large or small that their squares overflow or vanish are refused where they are handed over,
 * with words; no result is infinite or NaN with PLM_OK. */
#include "check.h"
#include "oscillator.h"

static const oscillator sane = {1, 0.1, 3, 0.1, 1};

typedef struct {
    plm_status status;
    char function[60], text[300];
} outcome;

static outcome built(oscillator o) {
    outcome out = {PLM_OK, "", ""};
    plm_context *ctx = NULL;
    plm_model *model = NULL;
    if (plm_context_create(PLM_API_VERSION, &ctx)) return out;
    out.status = oscillator_built(ctx, &o, 1, &model, NULL);
    if (out.status < 0) {
        plm_context_get_error_function(ctx, sizeof out.function, out.function, NULL);
        plm_context_get_error_text(ctx, sizeof out.text, out.text, NULL);
    }
    plm_context_destroy(&ctx);
    return out;
}

static int is_refused(const char *what, oscillator o, plm_status want, const char *function) {
    const outcome got = built(o);
    printf("    %s: %s\n", what, got.text);
    return got.status == want && strcmp(got.function, function) == 0;
}

static void models_of_absurd_size_are_refused(void **state) {
    oscillator o = sane;
    (void)state;
    assert_int_equal(built(o).status, PLM_OK);
    o.k = 4e297;
    assert_true(is_refused("spring", o, PLM_ERR_MATRIX, "plm_model_set_matrix_i64"));
    o.k = 1e-300;
    assert_true(is_refused("spring", o, PLM_ERR_MATRIX, "plm_model_build"));
    o = sane, o.force = 4e297;
    assert_true(is_refused("force", o, PLM_ERR_ARGUMENT, "plm_model_set_excitation"));
    o.force = 1e-300;
    assert_true(is_refused("force", o, PLM_ERR_ARGUMENT, "plm_model_build"));
    o = sane, o.k_n = 1e300;
    assert_true(is_refused("contact", o, PLM_ERR_ARGUMENT, "plm_model_add_gap_rows_i64"));
    o = sane, o.gap = -1e200;
    assert_true(is_refused("gap", o, PLM_ERR_ARGUMENT, "plm_model_add_gap_rows_i64"));
    o = sane, o.c = 1e100;
    assert_true(is_refused("damper", o, PLM_ERR_ARGUMENT, "plm_model_set_rayleigh_damping"));
}

/* Sums of what was handed over, too. */
static void matrices_of_absurd_size_are_refused(void **state) {
    static const int64_t at[2] = {0, 0};
    static const int32_t which[3] = {PLM_MASS, PLM_STIFFNESS, PLM_DAMPING};
    static const char *const words[3] = {"mass matrix", "stiffness matrix", "damping matrix"};
    static const double sizes[2] = {0.9e60, 0.9e-70};
    int k, s;
    (void)state;
    for (k = 0; k < 3; ++k)
        for (s = 0; s < 2; ++s) {
            const double one[2] = {1, 1}, absurd[2] = {sizes[s], sizes[s]};
            plm_context *ctx = NULL;
            plm_model *model = NULL;
            int j;
            assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
            assert_int_equal(plm_model_create(ctx, 1, &model), PLM_OK);
            for (j = 0; j < 3; ++j)
                assert_int_equal(plm_model_set_matrix_i64(model, which[j], PLM_TRIPLETS, PLM_FULL, 0,
                                                          PLM_COPY, 2, at, at, j == k ? absurd : one),
                                 PLM_OK);
            assert_true(refused(ctx, plm_model_build(model), PLM_ERR_MATRIX, "plm_model_build", "value", -1,
                                words[k]));
            plm_context_destroy(&ctx);
        }
}

static void frequencies_of_absurd_size_are_refused(void **state) {
    plm_context *ctx = NULL;
    plm_model *model = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *branch = NULL;
    (void)state;
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    assert_int_equal(oscillator_built(ctx, &sane, 1, &model, &basis), PLM_OK);
    assert_int_equal(plm_hbm_create(basis, &hbm), PLM_OK);
    assert_true(refused(ctx, plm_hbm_solve(hbm, 1e-300, NULL, 0, &branch), PLM_ERR_ARGUMENT, "plm_hbm_solve",
                        "frequency_hz", -1, "1e-300"));
    assert_true(refused(ctx, plm_hbm_set_double(hbm, "frequency_min_hz", 1e-300), PLM_ERR_ARGUMENT,
                        "plm_hbm_set_double", "value", -1, "1e-300"));
    assert_true(refused(ctx, plm_hbm_set_double(hbm, "force_scale", 1e200), PLM_ERR_ARGUMENT,
                        "plm_hbm_set_double", "value", -1, "1e+200"));
    assert_null(branch);
    assert_int_equal(plm_hbm_set_double(hbm, "force_scale", 0),
                     PLM_OK); /* nothing at all is no small number */
    assert_int_equal(plm_context_destroy(&ctx), PLM_OK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_of_absurd_size_are_refused),
        cmocka_unit_test(matrices_of_absurd_size_are_refused),
        cmocka_unit_test(frequencies_of_absurd_size_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
